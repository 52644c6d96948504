"""Sensor noise of a camera: an error of every pixel, and a varying brightness."""

from functools import lru_cache

import cv2
import numpy as np

from procs.vision.colours import Picture

_SPARE_PX = 128  # the noise field is larger than a picture by this, and each frame uses another part of it
_SEED = 1  # of the noise field


class SensorNoise:
    """Adds noise drawn beforehand: fresh random numbers for every pixel would cost more than the whole picture.

    All cameras with pictures of one shape share a field of noise, so that it stays in the processor's cache.
    """

    def __init__(
        self,
        shape: tuple[int, ...],
        levels: float,
        brightness: float,
        flicker: float,
        *,
        blur_px: float = 0.0,
        vignette: float = 0.0,
        cast: tuple[float, ...] = (1.0,),
    ) -> None:
        """Draws the noise, and computes the flaws of the lens.

        Args:
            shape: height and width of the pictures, and the number of their colours unless they are grey.
            levels: standard deviation of the noise, of 255.
            brightness: mean factor on all colours.
            flicker: standard deviation of the brightness, as a part of it.
            blur_px: standard deviation of the blur.
            vignette: part of the brightness that is missing at the picture's edge.
            cast: factors on blue, green and red, or one on all.
        """
        self._lighter, self._darker = _noise(shape, levels)
        self._noisy = levels > 0
        self._brightness = brightness
        self._flicker = flicker
        self._blur_px = blur_px
        down, right = (np.linspace(-1.0, 1.0, length_px) for length_px in shape[:2])
        square = np.minimum(down[:, None] ** 2 + right**2, 1.0)
        factors = (1.0 - vignette * square)[..., None] * np.maximum(cast, 0.0)
        factors = np.broadcast_to(factors, shape) if len(shape) == 3 else factors[..., 0]
        self._most = float(factors.max())
        self._shade = np.round(255 * factors / max(self._most, 1e-9)).astype(np.uint8)
        self._even = bool((factors == 1.0).all())

    def apply(self, frame: Picture, rng: np.random.Generator) -> Picture:
        """Returns the picture with noise; draws equally many random numbers for every frame."""
        top, left = rng.integers(_SPARE_PX, size=2)
        if self._blur_px:
            frame = np.asarray(cv2.GaussianBlur(frame, (0, 0), self._blur_px), np.uint8)
        gain = self._brightness * (1.0 + self._flicker * rng.standard_normal())
        if gain != 1.0 or not self._even:
            frame = np.asarray(cv2.multiply(frame, self._shade, scale=max(gain, 0.0) * self._most / 255), np.uint8)
        if not self._noisy:
            return frame
        height, width = frame.shape[:2]
        part = np.s_[top : top + height, left : left + width]
        noisy = cv2.add(frame, self._lighter[part])
        return np.asarray(cv2.subtract(noisy, self._darker[part], noisy), np.uint8)


@lru_cache(maxsize=4)
def _noise(shape: tuple[int, ...], levels: float) -> tuple[Picture, Picture]:
    """Returns what the noise adds to, and what it takes from, each pixel of a field larger than a picture."""
    height_px, width_px, *colours = shape
    drawn = np.random.default_rng(_SEED).standard_normal((height_px + _SPARE_PX, width_px + _SPARE_PX, *colours))
    drawn = np.round(drawn * levels)
    return drawn.clip(0, 255).astype(np.uint8), (-drawn).clip(0, 255).astype(np.uint8)

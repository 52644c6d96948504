"""Sensor noise of a camera: an error of every pixel, and a varying brightness."""

import cv2
import numpy as np

from procs.vision.colours import Picture

_SPARE_PX = 64  # the noise field is larger than a picture by this, and each frame uses another part of it


class SensorNoise:
    """Adds noise drawn beforehand: fresh random numbers for every pixel would cost more than the whole picture."""

    def __init__(self, size_px: int, levels: float, brightness: float, flicker: float, seed: int) -> None:
        """`levels`: standard deviation of 255; `brightness`: mean factor; `flicker`: its deviation, as a part of it."""
        drawn = np.random.default_rng(seed).standard_normal((size_px + _SPARE_PX, size_px + _SPARE_PX, 3))
        drawn = np.round(drawn * levels)
        self._lighter = drawn.clip(0, 255).astype(np.uint8)
        self._darker = (-drawn).clip(0, 255).astype(np.uint8)
        self._noisy = levels > 0
        self._size_px = size_px
        self.spoil_lens(0.0, 0.0)
        self._brightness = brightness
        self._flicker = flicker
        self.cast = np.ones(3)
        """Factors on blue, green and red."""

    def spoil_lens(self, blur_px: float, vignette: float) -> None:
        """Sets the blur, and the part of the brightness that is missing at the picture's edge."""
        self._blur_px = blur_px
        self._shade: Picture | None = None
        if vignette:
            from_centre = np.linspace(-1.0, 1.0, self._size_px)
            square = np.minimum(from_centre[:, None] ** 2 + from_centre**2, 1.0)
            shade = np.round(255 * (1.0 - vignette * square)).astype(np.uint8)
            self._shade = np.repeat(shade[..., None], 3, axis=2)

    def apply(self, frame: Picture, rng: np.random.Generator) -> Picture:
        """Returns the picture with noise; draws equally many random numbers for every frame."""
        top, left = rng.integers(_SPARE_PX, size=2)
        if self._blur_px:
            frame = np.asarray(cv2.GaussianBlur(frame, (0, 0), self._blur_px), np.uint8)
        if self._shade is not None:
            frame = np.asarray(cv2.multiply(frame, self._shade, scale=1 / 255), np.uint8)
        gain = self._brightness * (1.0 + self._flicker * rng.standard_normal())
        if gain != 1.0 or (self.cast != 1.0).any():
            factors = max(gain, 0.0) * self.cast
            levels = np.round(np.arange(256)[:, None, None] * factors).clip(0, 255).astype(np.uint8)
            frame = np.asarray(cv2.LUT(frame, levels), np.uint8)
        if not self._noisy:
            return frame
        height, width = frame.shape[:2]
        part = np.s_[top : top + height, left : left + width]
        noisy = cv2.add(frame, self._lighter[part])
        return np.asarray(cv2.subtract(noisy, self._darker[part], noisy), np.uint8)

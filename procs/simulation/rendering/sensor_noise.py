"""Sensor noise of a camera: every pixel a little wrong, and the brightness not quite steady."""

import cv2
import numpy as np

from procs.vision.colours import Picture

_SPARE_PX = 64  # the noise field is that much larger than a picture, and each frame takes another part of it


class SensorNoise:
    """Adds noise drawn beforehand: fresh random numbers for every pixel would cost more than the whole picture."""

    def __init__(self, size_px: int, levels: float, brightness: float, flicker: float, seed: int) -> None:
        """`levels`: standard deviation of 255; `brightness`: mean factor; `flicker`: its deviation, as a part of it."""
        drawn = np.random.default_rng(seed).standard_normal((size_px + _SPARE_PX, size_px + _SPARE_PX, 3))
        drawn = np.round(drawn * levels)
        self._lighter = drawn.clip(0, 255).astype(np.uint8)
        self._darker = (-drawn).clip(0, 255).astype(np.uint8)
        self._noisy = levels > 0
        self._brightness = brightness
        self._flicker = flicker

    def apply(self, frame: Picture, rng: np.random.Generator) -> Picture:
        """Returns the picture with noise; draws equally many random numbers for every frame."""
        top, left = rng.integers(_SPARE_PX, size=2)
        gain = self._brightness * (1.0 + self._flicker * rng.standard_normal())
        if gain != 1.0:
            levels = np.round(np.arange(256) * max(gain, 0.0)).clip(0, 255).astype(np.uint8)
            frame = np.asarray(cv2.LUT(frame, levels), np.uint8)
        if not self._noisy:
            return frame
        height, width = frame.shape[:2]
        part = np.s_[top : top + height, left : left + width]
        return np.asarray(cv2.subtract(cv2.add(frame, self._lighter[part]), self._darker[part]), np.uint8)

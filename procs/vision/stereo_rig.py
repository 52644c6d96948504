"""Calibration of a forward pair of pinhole cameras, level and parallel; both frames lie side by side in one picture."""

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from fwk import Config
from procs.model.algebra import Floats
from procs.vision.framing import scaled

Grey = NDArray[np.uint8]
"""Height x width."""


class StereoRig(Config):
    """The pair as it was calibrated; camera and detector use the same."""

    width_px: int = Field(default=400, ge=64, le=1600)
    """Width of each frame, in pixels."""
    height_px: int = Field(default=200, ge=32, le=1200)
    """Height of each frame, in pixels."""
    focal_px: float = Field(default=300.0, gt=0.0)
    """Focal length: a thing as wide as it is far away is so wide in the picture."""
    baseline_m: float = Field(default=0.16, gt=0.0)
    """Distance between the two cameras, which look along the robot's x axis."""
    forward_m: float = 0.1
    """Distance from the robot's middle forward to the cameras."""
    height_m: float = Field(default=0.5, gt=0.0)
    """Height of the cameras above the ground."""

    @property
    def columns(self) -> Floats:
        """(width_px): sideways part of each column's direction, to the right, for one metre ahead."""
        return np.asarray((np.arange(self.width_px, dtype=np.float64) - (self.width_px - 1) / 2) / self.focal_px)

    @property
    def rows(self) -> Floats:
        """(height_px): downward part of each row's direction, for one metre ahead."""
        return np.asarray((np.arange(self.height_px, dtype=np.float64) - (self.height_px - 1) / 2) / self.focal_px)

    def halves(self, pixels: Grey) -> tuple[Grey, Grey]:
        """Returns the frames of the left and the right camera from both side by side, in any size, grey or coloured."""
        grey = cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY) if pixels.ndim == 3 else pixels
        pair = scaled(np.asarray(grey, np.uint8), 2 * self.width_px, self.height_px)
        return pair[:, : self.width_px], pair[:, self.width_px :]

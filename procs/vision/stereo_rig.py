"""Calibration of a forward pair of level, parallel pinhole cameras, whose frames lie side by side in one picture."""

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator

from fwk import Config
from procs.model.algebra import Floats
from procs.vision.framing import central_part, scaled

Grey = NDArray[np.uint8]
"""Height x width."""

_LEAST_WIDTH_PX, _LEAST_HEIGHT_PX = 160, 80
_SHORTEST, _LONGEST = 0.25, 5.0  # focal length divided by the width of a frame


class StereoRig(Config):
    """Calibration of the pair, which camera and detector share."""

    width_px: int = Field(default=400, ge=_LEAST_WIDTH_PX, le=1600)
    """Width of each frame, in pixels."""
    height_px: int = Field(default=200, ge=_LEAST_HEIGHT_PX, le=1200)
    """Height of each frame, in pixels."""
    focal_px: float = Field(default=300.0, gt=0.0)
    """Focal length in pixels: width in the picture of an object that is as wide as its distance."""
    baseline_m: float = Field(default=0.16, ge=0.02, le=0.6)
    """Distance between the two cameras, which look along the robot's x axis."""
    forward_m: float = Field(default=0.1, ge=-0.5, le=0.5)
    """Distance from the robot's middle forward to the cameras."""
    height_m: float = Field(default=0.5, gt=0.1, le=2.0)
    """Height of the cameras above the ground."""

    @field_validator("focal_px")
    @classmethod
    def _possible(cls, focal_px: float, info: ValidationInfo) -> float:
        """Refuses lenses that would see more than 127 or less than 11 degrees of the width, checked before."""
        width_px = info.data.get("width_px")
        if width_px and not _SHORTEST <= focal_px / width_px <= _LONGEST:
            shortest_px, longest_px = _SHORTEST * width_px, _LONGEST * width_px
            raise ValueError(
                f"focal_px of {focal_px:g} should be from {shortest_px:g} to {longest_px:g} for frames of {width_px} px"
            )
        return focal_px

    @property
    def columns(self) -> Floats:
        """(width_px): sideways part of each column's direction, to the right, for one metre ahead."""
        return np.asarray((np.arange(self.width_px, dtype=np.float64) - (self.width_px - 1) / 2) / self.focal_px)

    @property
    def rows(self) -> Floats:
        """(height_px): downward part of each row's direction, for one metre ahead."""
        return np.asarray((np.arange(self.height_px, dtype=np.float64) - (self.height_px - 1) / 2) / self.focal_px)

    def shows_from_m(self, height_m: float) -> float:
        """Returns the distance ahead from which on the pictures show what is that high above the ground."""
        return abs(self.height_m - height_m) / float(self.rows[-1])

    def reduced(self, focal_px: float) -> "StereoRig":
        """Returns the calibration of the same view in smaller frames, with this focal length or the next larger one.

        Returns the same calibration if its focal length is not larger or if its frames are the smallest.
        """
        least = max(_LEAST_WIDTH_PX / self.width_px, _LEAST_HEIGHT_PX / self.height_px)
        share = max(focal_px / self.focal_px, least)
        if share >= 1.0:
            return self
        width_px, height_px = round(share * self.width_px), round(share * self.height_px)
        real_px = self.focal_px * width_px / self.width_px
        return self.model_copy(update={"width_px": width_px, "height_px": height_px, "focal_px": real_px})

    def cropped(self, pixels: Grey) -> Grey:
        """Returns both frames side by side, grey, each cropped to its central part with the aspect of this calibration.

        Raises:
            ValueError: the frames are neither grey nor have three colours.
        """
        grey = _grey(pixels)
        half_px = max(1, grey.shape[1] // 2)
        frames = (grey[:, :half_px], grey[:, -half_px:])
        left, right = (central_part(frame, self.width_px / self.height_px) for frame in frames)
        return grey if left.shape == frames[0].shape else np.hstack((left, right))

    def halves(self, pixels: Grey) -> tuple[Grey, Grey]:
        """Returns the frames of the left and the right camera from both side by side, in any size, grey or coloured.

        Raises:
            ValueError: the frames are neither grey nor have three colours.
        """
        pair = scaled(_grey(pixels), 2 * self.width_px, self.height_px)
        return pair[:, : self.width_px], pair[:, self.width_px :]


def _grey(pixels: Grey) -> Grey:
    """Returns the picture, grey or coloured, in grey.

    Raises:
        ValueError: it is neither grey nor has three colours.
    """
    channels = pixels.shape[2] if pixels.ndim == 3 else 1
    if channels not in (1, 3):
        shape = " x ".join(map(str, pixels.shape))
        raise ValueError(f"the frame is {shape}; the pair needs grey or three colours")
    grey = pixels.reshape(pixels.shape[:2]) if channels == 1 else cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey, np.uint8)

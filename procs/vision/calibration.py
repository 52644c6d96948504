"""Settings that the camera and the detectors share: the calibration of the mirror."""

import math

from pydantic import Field

from fwk import Config
from procs.vision.colours import Picture
from procs.vision.mirror import Mirror


class MirrorConfig(Config):
    """The mirror as it was calibrated; the camera and both detectors of a robot use the same."""

    size_px: int = Field(default=400, ge=64, le=1600)
    """Height and width of the picture."""
    height_m: float = Field(default=0.75, gt=0.0)
    """Effective viewpoint of the mirror above the ground."""
    view_angle_deg: float = Field(default=92.0, gt=45.0, lt=150.0)
    """Angle from straight down that the picture's edge sees; 90 is the horizon."""

    def check_frame(self, pixels: Picture, component: str) -> None:
        """Raises ValueError for a frame that the calibration does not fit."""
        wanted = (self.size_px, self.size_px, 3)
        if pixels.shape != wanted:
            raise ValueError(
                f"{component}: the frame is {' x '.join(map(str, pixels.shape))}, but mirror.size_px says "
                f"{' x '.join(map(str, wanted))}; give camera and detector the same mirror settings, "
                "or a camera driver width_px and height_px"
            )

    def mirror(self, roll_deg: float = 0.0, pitch_deg: float = 0.0) -> Mirror:
        """The mirror itself, tilted about the robot's x and y axis."""
        return Mirror(
            size_px=self.size_px,
            height_m=self.height_m,
            view_angle_rad=math.radians(self.view_angle_deg),
            roll_rad=math.radians(roll_deg),
            pitch_rad=math.radians(pitch_deg),
        )

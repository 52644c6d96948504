"""Settings that the camera and the detectors share: the calibration of the mirror."""

import math

from pydantic import Field, ValidationInfo

from fwk import Config
from procs.model.ball import BallModel
from procs.vision.colours import Picture
from procs.vision.framing import central_part, scaled
from procs.vision.mirror import Mirror


class MirrorConfig(Config):
    """Calibration of the mirror, which the camera and both detectors of a robot share."""

    size_px: int = Field(default=430, ge=64, le=1600)
    """Height and width of the picture."""
    height_m: float = Field(default=0.75, gt=0.3, le=2.0)
    """Effective viewpoint of the mirror above the ground, above any ball. Rule book of 2016: robots up to 0.80 m."""
    view_angle_deg: float = Field(default=96.0, gt=45.0, lt=150.0)
    """Angle from straight down that the picture's edge sees; 90 is the horizon, above which lobs fly."""

    def fitted(self, frame: Picture) -> Picture:
        """Returns the frame as the calibration describes it: its central square, `size_px` wide.

        The mirror's image is round and lies in the middle of the frame, whatever the shape of the camera's sensor.

        Raises:
            ValueError: the frame has no colours.
        """
        if frame.ndim != 3 or frame.shape[2] != 3:
            shape = " x ".join(map(str, frame.shape))
            raise ValueError(f"the frame is {shape}; the detectors need three colours, height x width x 3")
        return scaled(central_part(frame, 1.0), self.size_px, self.size_px)

    def mirror(self, roll_deg: float = 0.0, pitch_deg: float = 0.0) -> Mirror:
        """Returns the mirror, tilted about the robot's x and y axis."""
        return Mirror(
            size_px=self.size_px,
            height_m=self.height_m,
            view_angle_rad=math.radians(self.view_angle_deg),
            roll_rad=math.radians(roll_deg),
            pitch_rad=math.radians(pitch_deg),
        )


def below_mirror(ball: BallModel, info: ValidationInfo) -> BallModel:
    """Refuses a setting `ball` that reaches up to the mirror; the setting `mirror` has been checked before."""
    mirror: MirrorConfig | None = info.data.get("mirror")
    if mirror is not None and 2 * ball.radius_m >= mirror.height_m:
        raise ValueError(
            f"a ball of {2 * ball.radius_m:g} m reaches up to the mirror, which is {mirror.height_m:g} m high"
        )
    return ball

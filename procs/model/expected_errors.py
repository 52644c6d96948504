"""Errors of a robot's own sensors that its drivers and detectors state, for each preset of realism.

Covariances are honest only if they grow with the errors. A team measures its own robot and sets what it found; the
values here are those of the simulated one.
"""

from pydantic import BaseModel, ConfigDict, NonNegativeFloat, PositiveFloat

from procs.model.realism import Realism


class ExpectedErrors(BaseModel):
    """Standard deviations of what sensors report."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    ball_px: PositiveFloat = 0.23
    """A ball's centre in the picture of a standing robot; the shaking of its mirror is included."""
    ball_shake_s_m: NonNegativeFloat = 1.25
    """Growth of `ball_px` for each m/s of the robot, because the mirror of a faster robot shakes more; as a share."""
    robot_px: tuple[PositiveFloat, PositiveFloat] = (0.6, 1.5)
    """Another robot's middle in the picture of a standing one, along and across the ray; with the shaking."""
    robot_shake_s_m: NonNegativeFloat = 0.35
    """Growth of `robot_px` for each m/s of the robot, as a share."""
    stereo_px: PositiveFloat = 0.2
    """A disparity of the stereo pair, in pixels of the frames that are searched. Both frames shake alike."""
    frame_m: NonNegativeFloat = 0.006
    """A position by the lines of one frame: the part of its error that all points of the frame share."""
    frame_rad: NonNegativeFloat = 0.002
    """The same of a heading."""
    frame_s: NonNegativeFloat = 0.02
    """Growth of `frame_m` for each m/s of the robot, because the mirror of a faster robot shakes more."""
    frame_rad_s_m: NonNegativeFloat = 0.001
    """Growth of `frame_rad` for each m/s of the robot."""
    lasting_m: NonNegativeFloat = 0.0
    """A position: the part of its error that is the same in all frames, such as that of a tilted mirror; averaging
    frames does not remove it."""
    lasting_rad: NonNegativeFloat = 0.0
    """The same of a heading."""
    wheel_scale_sd: NonNegativeFloat = 0.03
    """Relative error of each wheel's speed that stays the same for a long time, such as that of a worn wheel."""
    wheel_noise_sqrt_s: NonNegativeFloat = 0.0112
    """Relative error of the distance that a wheel measures in one second."""

    def in_coarser_picture(self, factor: float) -> "ExpectedErrors":
        """Returns the errors for a picture in which a pixel covers `factor` times as many metres as usual.

        Errors in pixels stay as they are. So do the lasting ones, which come from the tilt of the mirror.
        """
        grown = ("frame_m", "frame_rad", "frame_s", "frame_rad_s_m")
        return self.model_copy(update={name: factor * getattr(self, name) for name in grown})


EXPECTED: dict[Realism, ExpectedErrors] = {
    "none": ExpectedErrors(
        ball_px=0.15,
        ball_shake_s_m=0.0,
        robot_px=(0.3, 0.75),
        robot_shake_s_m=0.0,
        stereo_px=0.15,
        frame_s=0.0,
        frame_rad_s_m=0.0,
        wheel_scale_sd=0.0,
        wheel_noise_sqrt_s=0.0,
    ),
    "friendly": ExpectedErrors(
        ball_px=0.12,
        robot_px=(0.3, 0.75),
        stereo_px=0.15,
        frame_s=0.01,
        frame_rad_s_m=0.0005,
        wheel_scale_sd=0.01,
        wheel_noise_sqrt_s=0.0045,
    ),
    "realistic": ExpectedErrors(),
    "harsh": ExpectedErrors(
        ball_px=1.9,
        ball_shake_s_m=0.45,
        robot_px=(1.7, 3.3),
        stereo_px=0.3,
        frame_m=0.05,
        frame_rad=0.01,
        frame_s=0.04,
        frame_rad_s_m=0.002,
        lasting_m=0.05,
        lasting_rad=0.008,
        wheel_scale_sd=0.06,
        wheel_noise_sqrt_s=0.0224,
    ),
}
"""`harsh` has a mirror that is tilted by 0.3 degrees: 0.8 px in one direction of the robot, in all frames."""

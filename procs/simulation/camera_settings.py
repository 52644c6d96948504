"""Settings that all simulated cameras have: errors of the preset, signs of use, and the bodies that they show."""

from pydantic import Field as Setting

from fwk import Config
from procs.model.ball import BALL, BallModel
from procs.model.field import Field, MatchField
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, RobotModel
from procs.simulation.camera_errors import PRESETS, CameraErrors
from procs.simulation.rendering.carpet import Wear
from procs.simulation.rendering.sensor_noise import SensorNoise


class CameraSettings(Config):
    """Settings of a simulated camera; errors that are not null override the preset."""

    realism: Realism = "realistic"
    """Deviation of the camera from the ideal: none, friendly, realistic or harsh. Non-null settings override it."""
    latency_s: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Delay from the exposure until the frame is published; rendering shows the world at the exposure."""
    shake_px: float | None = Setting(default=None, ge=0.0, le=3.0)
    """Standard deviation by which the standing robot shakes the picture."""
    shake_px_per_m_s: float | None = Setting(default=None, ge=0.0, le=3.0)
    """Growth of that deviation with each m/s of the robot."""
    noise_levels: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Standard deviation of the sensor noise, of 255."""
    brightness: float = Setting(default=1.0, gt=0.0, le=4.0)
    """Factor on all colours."""
    flicker: float | None = Setting(default=None, ge=0.0, le=0.5)
    """Standard deviation of the brightness from frame to frame, as a part of it."""
    blur_px: float | None = Setting(default=None, ge=0.0, le=5.0)
    """Standard deviation of the blur of lens and motion."""
    vignette: float | None = Setting(default=None, ge=0.0, le=0.9)
    """Part of the brightness that is missing at the picture's edge."""
    cast: float | None = Setting(default=None, ge=0.0, le=0.3)
    """Standard deviation of a factor on each of the three colours, or on the grey of each camera of a pair; constant in
    a match."""
    tilt_sd_deg: float | None = Setting(default=None, ge=0.0, le=2.0)
    """Standard deviation of an uncalibrated tilt about the robot's x and y axis, constant in a match."""
    worn: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the lines' paint that is missing."""
    clutter_1_m2: float | None = Setting(default=None, ge=0.0, le=10.0)
    """White specks on a square metre of the floor around the field."""
    bare_m: float = Setting(default=0.0625, gt=0.0, le=1.0)
    """Width of a place where paint is missing, in metres: half a line. An estimate."""
    speck_m: float = Setting(default=0.06, gt=0.0, le=1.0)
    """Radius of a white speck, in metres: as wide as a line. An estimate."""
    gaps_1_min: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Interruptions in a minute, in which frames are lost in a row."""
    gap_s: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Mean duration of an interruption."""
    field: MatchField = Field()
    """Measures of the field."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size of the ball."""

    @property
    def errors(self) -> CameraErrors:
        """Errors of the preset and those that override them."""
        return chosen(PRESETS[self.realism], self)

    def noise(self, shape: tuple[int, ...], cast: tuple[float, ...]) -> SensorNoise:
        """Returns what lens and sensor do to pictures of a shape, with a colour cast; see `SensorNoise`."""
        errors = self.errors
        return SensorNoise(
            shape,
            errors.noise_levels,
            self.brightness,
            errors.flicker,
            blur_px=errors.blur_px,
            vignette=errors.vignette,
            cast=cast,
        )

    @property
    def wear(self) -> Wear:
        """Signs of use on the field."""
        errors = self.errors
        return Wear(errors.worn, errors.clutter_1_m2, self.bare_m, self.speck_m)

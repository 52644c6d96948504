"""Simulated omnidirectional camera: renders the view of its robot and publishes the frames."""

import math

import cv2
import numpy as np
from pydantic import Field as Setting
from pydantic import field_validator

from fwk import Clock, Component, Config, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.model.geometry import plausible
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, RobotModel, team_in
from procs.simulation.camera_errors import PRESETS, CameraErrors
from procs.simulation.delayed_truth import DelayedTruth, Exposure
from procs.simulation.gaps import Gaps
from procs.simulation.rendering.carpet import Wear
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig, below_mirror
from procs.vision.colours import BLACK, COLOURS


class CameraConfig(Config):
    """Settings of the simulated camera."""

    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the mirror, as the detectors have it."""
    roll_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's x axis."""
    pitch_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's y axis."""
    realism: Realism = "realistic"
    """Deviation of the camera from the ideal: none, friendly, realistic or harsh. Non-null settings override it."""
    latency_s: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Delay from the exposure until the frame is published; rendering shows the world at the exposure."""
    shake_px: float | None = Setting(default=None, ge=0.0, le=3.0)
    """Standard deviation by which the standing robot's mirror shakes the picture."""
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
    """Standard deviation of a factor on each of the three colours, constant in a match."""
    tilt_sd_deg: float | None = Setting(default=None, ge=0.0, le=2.0)
    """Standard deviation of a further tilt about either axis, constant in a match."""
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
    field: Field = Field()
    """Measures of the field."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size of the ball."""

    _visible = field_validator("ball")(below_mirror)


class Camera(Component):
    """Renders the picture of the robot's camera from the true poses of the simulator."""

    stage = "sensor_acquire"
    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    image: VisionMaster
    config: CameraConfig
    clock: Clock
    log: Logger
    rng: np.random.Generator

    @classmethod
    def preload(cls, config: CameraConfig) -> None:
        """Computes the painted field and the noise, which are the same for all robots."""
        errors = chosen(PRESETS[config.realism], config)
        mirror = config.mirror.mirror(config.roll_deg, config.pitch_deg)
        Renderer(mirror, config.field, Bodies.of(config.robot, config.ball), _wear(errors, config))
        SensorNoise(mirror.size_px, errors.noise_levels, config.brightness, errors.flicker)

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._delayed = DelayedTruth(self.name, "pictures", self.log)
        built, interrupted = self.rng.spawn(2)
        self._tilts, self._casts = built.standard_normal(2), built.standard_normal(3)
        self._gaps = Gaps(interrupted)
        self._apply_settings()

    def loop(self) -> None:
        seen = self._delayed.expose(self.ground_truth, self._errors.latency_s)
        if seen and not self._gaps.blind(self.clock.now_us, self._errors.gaps_1_min, self._errors.gap_s):
            frame = self._renderer.render(self._scene(seen), self._shake_px(seen.own))
            self.image.publish(self._noise.apply(frame, self.rng), seen.capture_us)

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        errors = self._errors = chosen(PRESETS[config.realism], config)
        roll_deg, pitch_deg = (errors.tilt_sd_deg * self._tilts).tolist()
        mirror = config.mirror.mirror(config.roll_deg + roll_deg, config.pitch_deg + pitch_deg)
        self._renderer = Renderer(mirror, config.field, Bodies.of(config.robot, config.ball), _wear(errors, config))
        blue, green, red = (1.0 + errors.cast * self._casts).tolist()
        self._noise = SensorNoise(
            config.mirror.size_px,
            errors.noise_levels,
            config.brightness,
            errors.flicker,
            blur_px=errors.blur_px,
            vignette=errors.vignette,
            cast=(blue, green, red),
        )

    def _scene(self, seen: Exposure) -> Scene:
        # A robot that is not a player has no marker: a black one on a black body.
        others = [(robot.x_m, robot.y_m, COLOURS.get(team_in(robot), BLACK)) for robot in seen.others]
        own, truth = seen.own, seen.truth
        ball_m = (truth.ball_x_m, truth.ball_y_m, truth.ball_z_m + self.config.ball.radius_m)
        return Scene(Pose(own.x_m, own.y_m, own.heading_rad), others, ball_m if plausible(*ball_m) else None)

    def _shake_px(self, own: true_robot_t) -> tuple[float, float]:
        speed_m_s = math.hypot(own.vx_m_s, own.vy_m_s)
        deviation_px = self._errors.shake_px + self._errors.shake_px_per_m_s * speed_m_s
        right_px, down_px = deviation_px * self.rng.standard_normal(2)
        return float(right_px), float(down_px)


def _wear(errors: CameraErrors, config: CameraConfig) -> Wear:
    return Wear(errors.worn, errors.clutter_1_m2, config.bare_m, config.speck_m)

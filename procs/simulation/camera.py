"""Simulated omnidirectional camera: renders the view of its robot and publishes the frames."""

import cv2
import numpy as np
from pydantic import Field as Setting
from pydantic import field_validator

from fwk import Clock, Component, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t
from procs.model.geometry import plausible
from procs.model.robot import team_in
from procs.simulation.camera_settings import CameraSettings
from procs.simulation.delayed_truth import DelayedTruth, Exposure
from procs.simulation.gaps import Gaps
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig, below_mirror
from procs.vision.colours import BLACK, COLOURS, Picture


class CameraConfig(CameraSettings):
    """Settings of the simulated camera."""

    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the mirror, as the detectors have it."""
    roll_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's x axis, besides that of the preset."""
    pitch_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's y axis, besides that of the preset."""

    frozen: bool = False
    """The camera hangs: it repeats the picture at hand as if it were new."""

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
        errors = config.errors
        mirror = config.mirror.mirror(config.roll_deg, config.pitch_deg)
        Renderer(mirror, config.field, Bodies.of(config.robot, config.ball), config.wear)
        SensorNoise((mirror.size_px, mirror.size_px, 3), errors.noise_levels, config.brightness, errors.flicker)

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._delayed = DelayedTruth(self.name, "pictures", self.log)
        built, interrupted = self.rng.spawn(2)
        self._tilts, self._casts = built.standard_normal(2), built.standard_normal(3)
        self._gaps = Gaps(interrupted)
        self._frozen: Picture | None = None
        self._apply_settings()

    def loop(self) -> None:
        seen = self._delayed.expose(self.ground_truth, self._errors.latency_s)
        if seen and not self._gaps.blind(self.clock.now_us, self._errors.gaps_1_min, self._errors.gap_s):
            repeated = self._frozen if self.config.frozen else None
            picture = self._picture(seen) if repeated is None else repeated
            self._frozen = picture if self.config.frozen else None
            self.image.publish(picture, seen.capture_us)

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        errors = self._errors = config.errors
        roll_deg, pitch_deg = (errors.tilt_sd_deg * self._tilts).tolist()
        mirror = config.mirror.mirror(config.roll_deg + roll_deg, config.pitch_deg + pitch_deg)
        self._renderer = Renderer(mirror, config.field, Bodies.of(config.robot, config.ball), config.wear)
        blue, green, red = (1.0 + errors.cast * self._casts).tolist()
        self._noise = config.noise((mirror.size_px, mirror.size_px, 3), (blue, green, red))

    def _picture(self, seen: Exposure) -> Picture:
        frame = self._renderer.render(self._scene(seen), self._errors.drawn_shake_px(seen.own, self.rng))
        return self._noise.apply(frame, self.rng)

    def _scene(self, seen: Exposure) -> Scene:
        # A robot that is not a player has no marker: a black one on a black body.
        others = [(robot.x_m, robot.y_m, COLOURS.get(team_in(robot), BLACK)) for robot in seen.others]
        own, truth = seen.own, seen.truth
        ball_m = (truth.ball_x_m, truth.ball_y_m, truth.ball_z_m + self.config.ball.radius_m)
        return Scene(Pose(own.x_m, own.y_m, own.heading_rad), others, ball_m if plausible(*ball_m) else None)

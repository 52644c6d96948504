"""Simulated omnidirectional camera: renders the view of its robot and publishes the frames."""

import math

import cv2
import numpy as np
from pydantic import Field as Setting

from fwk import Component, Config, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.field import Field
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import CYAN, MAGENTA

_FARTHEST = 1e4  # metres, radians, metres a second


class CameraConfig(Config):
    """Settings of the simulated camera."""

    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the mirror, as the detectors have it."""
    roll_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's x axis."""
    pitch_deg: float = Setting(default=0.0, ge=-5.0, le=5.0)
    """Uncalibrated tilt of the mirror about the robot's y axis."""
    shake_px: float = Setting(default=0.2, ge=0.0, le=3.0)
    """Standard deviation by which the standing robot's mirror shakes the picture."""
    shake_px_per_m_s: float = Setting(default=0.3, ge=0.0, le=3.0)
    """Growth of that deviation with each m/s of the robot."""
    noise_levels: float = Setting(default=5.0, ge=0.0, le=60.0)
    """Standard deviation of the sensor noise, of 255."""
    brightness: float = Setting(default=1.0, gt=0.0, le=4.0)
    """Factor on all colours."""
    flicker: float = Setting(default=0.0, ge=0.0, le=0.5)
    """Standard deviation of the brightness from frame to frame, as a part of it."""
    field: Field = Field()
    """Measures of the field."""
    robot_radius_m: float = Setting(default=0.25, gt=0.0)
    """Of all robots; they are round."""
    robot_height_m: float = Setting(default=0.6, ge=0.5)
    """Of all robots; the team markers are below."""
    ball_radius_m: float = Setting(default=0.11, gt=0.0)
    """Of the ball."""


class Camera(Component):
    """Renders the picture of the robot's camera from the true poses of the simulator."""

    stage = "sensor_acquire"
    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    image: VisionMaster
    config: CameraConfig
    log: Logger
    rng: np.random.Generator

    @classmethod
    def preload(cls, config: CameraConfig) -> None:
        """Computes the painted field and the maps of the mirror, which are the same for all robots."""
        Renderer(config.mirror.mirror(config.roll_deg, config.pitch_deg), config.field, _bodies(config))

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._robot = self.name.rpartition("/")[0]
        self._missing = False
        self._noise_seed = int(self.rng.integers(1 << 32))
        self._apply_settings()

    def loop(self) -> None:
        if not self.ground_truth.refreshed:
            return
        own = self._own_robot(self.ground_truth.value)
        if own is not None:
            frame = self._renderer.render(self._scene(own, self.ground_truth.value), self._shake_px(own))
            self.image.publish(self._noise.apply(frame, self.rng))

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        mirror = config.mirror.mirror(config.roll_deg, config.pitch_deg)
        self._renderer = Renderer(mirror, config.field, _bodies(config))
        self._noise = SensorNoise(
            config.mirror.size_px, config.noise_levels, config.brightness, config.flicker, self._noise_seed
        )

    def _own_robot(self, truth: ground_truth_t) -> true_robot_t | None:
        own = next((robot for robot in truth.robots if robot.name == self._robot and _is_here(robot)), None)
        if own is None and not self._missing:
            names = ", ".join(robot.name for robot in truth.robots) or "no robot"
            self.log.warning(f"no pictures: robot '{self._robot}' is not on the field, which has {names}")
        self._missing = own is None
        return own

    def _scene(self, own: true_robot_t, truth: ground_truth_t) -> Scene:
        others = [
            (robot.x_m, robot.y_m, CYAN if robot.name.startswith("cyan") else MAGENTA)
            for robot in truth.robots
            if robot.name != self._robot and _is_here(robot)
        ]
        ball_m = (truth.ball_x_m, truth.ball_y_m, truth.ball_z_m + self.config.ball_radius_m)
        return Scene(Pose(own.x_m, own.y_m, own.heading_rad), others, ball_m if _near(*ball_m) else None)

    def _shake_px(self, own: true_robot_t) -> tuple[float, float]:
        speed_m_s = math.hypot(own.vx_m_s, own.vy_m_s)
        deviation_px = self.config.shake_px + self.config.shake_px_per_m_s * speed_m_s
        right_px, down_px = deviation_px * self.rng.standard_normal(2)
        return float(right_px), float(down_px)


def _bodies(config: CameraConfig) -> Bodies:
    return Bodies(config.robot_radius_m, config.robot_height_m, config.ball_radius_m)


def _is_here(robot: true_robot_t) -> bool:
    return _near(robot.x_m, robot.y_m, robot.heading_rad, robot.vx_m_s, robot.vy_m_s)


def _near(*values: float) -> bool:
    """Returns whether the values can belong to something on the field; NaN and infinity cannot."""
    return all(abs(value) < _FARTHEST for value in values)

"""Simulated forward stereo pair: renders the view of its robot and publishes both frames as one."""

import cv2
import numpy as np
from pydantic import Field as Setting

from fwk import Component, Config, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t
from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.model.geometry import plausible
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, RobotModel
from procs.model.units import US_PER_S
from procs.simulation.camera_errors import PRESETS
from procs.simulation.past import Past
from procs.simulation.rendering.renderer import Pose
from procs.simulation.rendering.shapes import Bodies
from procs.simulation.rendering.stereo_renderer import StereoRenderer
from procs.vision.stereo_rig import StereoRig


class StereoCameraConfig(Config):
    """Settings of the simulated pair; those that are not null override the preset."""

    rig: StereoRig = StereoRig()
    """Calibration of the pair, as the detector has it."""
    realism: Realism = "realistic"
    """Deviation of the cameras from the ideal: none, friendly, realistic or harsh."""
    latency_s: float | None = Setting(default=None, ge=0.0, le=1.0)
    """From the exposure until the frame is published."""
    noise_levels: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Standard deviation of the sensor noise, of 255."""
    field: Field = Field()
    """Measures of the field."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size of the ball, which lies too low to be an obstacle."""


class StereoCamera(Component):
    """Renders both pictures from the true poses of the simulator."""

    stage = "sensor_acquire"
    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    stereo_image: VisionMaster
    config: StereoCameraConfig
    log: Logger
    rng: np.random.Generator

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._robot = self.name.rpartition("/")[0]
        self._past = Past()
        self._missing = False
        self._apply_settings()

    def loop(self) -> None:
        if not self.ground_truth.refreshed:
            return
        for truth in self.ground_truth.fresh:
            self._past.add(truth)
        capture_us = self.ground_truth.header.time_us - round(self._errors.latency_s * US_PER_S)
        robots = [
            robot for robot in self._past.at(capture_us).robots if plausible(robot.x_m, robot.y_m, robot.heading_rad)
        ]
        own = next((robot for robot in robots if robot.name == self._robot), None)
        if own is None and not self._missing:
            self.log.warning(f"no stereo pictures: robot '{self._robot}' is not on the field")
        self._missing = own is None
        if own is not None:
            others = [(robot.x_m, robot.y_m) for robot in robots if robot.name != self._robot]
            frame = self._renderer.render(Pose(own.x_m, own.y_m, own.heading_rad), others)
            noise = self._errors.noise_levels * self.rng.standard_normal(frame.shape, np.float32)
            self.stereo_image.publish(np.clip(frame + noise, 0, 255).astype(np.uint8), max(1, capture_us))

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        self._errors = chosen(PRESETS[config.realism], config)
        bodies = Bodies(config.robot.radius_m, config.robot.height_m, config.ball.radius_m)
        self._renderer = StereoRenderer(config.rig, config.field, bodies)

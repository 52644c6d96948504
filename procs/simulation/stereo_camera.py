"""Simulated forward stereo pair: renders the view of its robot and publishes both frames as one."""

import cv2
import numpy as np
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t
from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, RobotModel
from procs.simulation.camera_errors import PRESETS
from procs.simulation.delayed_truth import DelayedTruth
from procs.simulation.gaps import Gaps
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
    """Delay from the exposure until the frame is published."""
    noise_levels: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Standard deviation of the sensor noise, of 255."""
    gaps_1_min: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Interruptions in a minute, in which frames are lost in a row."""
    gap_s: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Mean duration of an interruption."""
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
    clock: Clock
    log: Logger
    rng: np.random.Generator

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._delayed = DelayedTruth(self.name, "stereo pictures", self.log)
        self._gaps = Gaps(self.rng.spawn(1)[0])
        self._apply_settings()

    def loop(self) -> None:
        seen = self._delayed.expose(self.ground_truth, self._errors.latency_s)
        if seen and not self._gaps.blind(self.clock.now_us, self._errors.gaps_1_min, self._errors.gap_s):
            own, others = seen.own, [(robot.x_m, robot.y_m) for robot in seen.others]
            frame = self._renderer.render(Pose(own.x_m, own.y_m, own.heading_rad), others)
            noise = self._errors.noise_levels * self.rng.standard_normal(frame.shape, np.float32)
            self.stereo_image.publish(np.clip(frame + noise, 0, 255).astype(np.uint8), seen.capture_us)

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        self._errors = chosen(PRESETS[config.realism], config)
        self._renderer = StereoRenderer(config.rig, config.field, Bodies.of(config.robot, config.ball))

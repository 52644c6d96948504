"""Simulated forward stereo pair: renders the view of its robot and publishes both frames as one."""

import math

import cv2
import numpy as np

from fwk import Clock, Component, Logger, Reads, VisionMaster, channel
from lcmtypes.soccer import ground_truth_t
from procs.simulation.camera_settings import CameraSettings
from procs.simulation.delayed_truth import DelayedTruth
from procs.simulation.gaps import Gaps
from procs.simulation.rendering.renderer import Pose
from procs.simulation.rendering.shapes import Bodies
from procs.simulation.rendering.stereo_renderer import StereoRenderer
from procs.vision.stereo_rig import StereoRig


class StereoCameraConfig(CameraSettings):
    """Settings of the simulated pair. The ball lies too low to be an obstacle."""

    rig: StereoRig = StereoRig()
    """Calibration of the pair, as the detector has it."""


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
        built, interrupted = self.rng.spawn(2)
        self._tilts, self._casts = built.standard_normal(2), built.standard_normal(2)
        self._gaps = Gaps(interrupted)
        self._apply_settings()

    def loop(self) -> None:
        seen = self._delayed.expose(self.ground_truth, self._errors.latency_s)
        if seen and not self._gaps.blind(self.clock.now_us, self._errors.gaps_1_min, self._errors.gap_s):
            own, others = seen.own, [(robot.x_m, robot.y_m) for robot in seen.others]
            shake_px = self._errors.drawn_shake_px(own, self.rng)
            pair = self._renderer.render(Pose(own.x_m, own.y_m, own.heading_rad), others, shake_px)
            halves = zip(self._noises, np.hsplit(pair, 2), strict=True)
            noisy = [noise.apply(np.ascontiguousarray(half), self.rng) for noise, half in halves]
            self.stereo_image.publish(np.hstack(noisy), seen.capture_us)

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        config = self.config
        errors = self._errors = config.errors
        roll_rad, pitch_rad = (math.radians(errors.tilt_sd_deg) * self._tilts).tolist()
        bodies = Bodies.of(config.robot, config.ball)
        self._renderer = StereoRenderer(config.rig, config.field, bodies, config.wear, (roll_rad, pitch_rad))
        casts = (1.0 + errors.cast * self._casts).tolist()
        self._noises = [config.noise((config.rig.height_px, config.rig.width_px), (cast,)) for cast in casts]

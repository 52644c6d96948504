"""A camera of noise, and watchers that are slow now and then."""

import os
import zlib
from pathlib import Path

import numpy as np

from fwk import Component, Config, Image, VisionMaster, Writes, channel
from fwk.clock import sleep_s
from lcmtypes.soccer import pose_t


class Camera(Component):
    """Publishes three frames in each tick."""

    stage = "sensor_acquire"
    image: VisionMaster
    rng: np.random.Generator

    def loop(self) -> None:
        for _ in range(3):
            self.image.publish(self.rng.integers(0, 256, (60, 80, 3), np.uint8))


class WatcherConfig(Config):
    slow: bool = False
    """Whether the watcher pauses now and then before it looks."""
    looks_first: bool = False
    """Whether the watcher pauses now and then after it has looked."""


class Watcher(Component):
    """Reports which frame was announced, what it saw, and how many frames it lost."""

    stage = "sensor_prepare"
    reaches_outside = False
    image: Image = channel("r/image")
    pose: Writes[pose_t]
    rng: np.random.Generator
    config: WatcherConfig

    def init(self) -> None:
        Path(self.name.replace("/", "-") + ".pid").write_text(str(os.getpid()))

    def loop(self) -> None:
        dawdles = self.rng.random() < 0.2
        if self.config.slow and dawdles:
            sleep_s(0.06)
        pixels = self.image.pixels
        if self.config.looks_first and dawdles:
            sleep_s(0.06)
        self.pose.value.x_m = float(self.image.announcement.value.frame)
        self.pose.value.y_m = -1.0 if pixels is None else float(zlib.crc32(pixels.tobytes()))
        self.pose.value.heading_rad = float(self.image.lost)
        self.pose.write()

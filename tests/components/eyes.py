"""A camera that is a device, a camera that is not, and their viewers."""

import os
import zlib
from pathlib import Path

import numpy as np

from fwk import Component, Config, Image, Reads, VisionMaster, Writes, channel
from lcmtypes.soccer import pose_t


class Device(Component):
    """Its pictures are never the same again; a replay must not run it."""

    stage = "sensor_acquire"
    image: VisionMaster

    @classmethod
    def unrepeatable(cls, config: Config) -> str:
        return "'the eye' is a device"

    def init(self) -> None:
        with Path("opened").open("a") as file:
            file.write("opened\n")

    def loop(self) -> None:
        for _ in range(2):
            noise = np.frombuffer(os.urandom(20 * 30 * 3), np.uint8)
            self.image.publish(noise.reshape(20, 30, 3))


class Grey(Component):
    """Grey pictures, determined by the run's seed."""

    stage = "sensor_acquire"
    image: VisionMaster
    rng: np.random.Generator

    def loop(self) -> None:
        self.image.publish(self.rng.integers(0, 256, (20, 30), np.uint8))


class Watcher(Component):
    """Reports which frame it saw."""

    stage = "sensor_prepare"
    image: Image
    pose: Writes[pose_t]

    def loop(self) -> None:
        pixels = self.image.pixels
        assert pixels is not None
        self.pose.value.x_m = float(zlib.crc32(pixels.tobytes()))
        self.pose.value.y_m = float(pixels.ndim)
        self.pose.write()


class Follower(Component):
    """Reads no frames."""

    stage = "think"
    pose: Reads[pose_t] = channel("a/pose")
    heading: Writes[pose_t]

    def loop(self) -> None:
        self.heading.value.heading_rad = self.pose.value.x_m / 1e9
        self.heading.write()

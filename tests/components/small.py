"""A counter, its follower, a camera and a viewer."""

import numpy as np

from fwk import Component, Config, Image, Logger, Reads, VisionMaster, Writes, channel
from fwk.clock import sleep_s
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class CounterConfig(Config):
    step: float = 1.0
    """Added in each iteration."""
    hang: bool = False
    """An iteration never ends."""


class Counter(Component):
    """Counts its iterations."""

    stage = "think"
    config: CounterConfig
    log: Logger
    imu: Writes[imu_t]

    def loop(self) -> None:
        while self.config.hang:
            sleep_s(0.01)
        self.imu.value.heading_rad += self.config.step
        self.imu.write()

    def config_changed(self) -> None:
        self.log.warning(f"step is {self.config.step}")

    def finalize(self) -> None:
        self.log.info("counted enough")


class Follower(Component):
    """Copies the counter's value; fails at 99."""

    stage = "act"
    imu: Reads[imu_t] = channel("r/imu")
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.heading_rad = self.imu.value.heading_rad
        self.pose.value.x_m = 1.0
        self.pose.write()


class Camera(Component):
    """Publishes frames."""

    stage = "sensor_acquire"
    image: VisionMaster

    def loop(self) -> None:
        self.image.publish(np.zeros((4, 4), np.uint8))


class Finder(Component):
    """Looks at the camera's frames."""

    stage = "sensor_prepare"
    image: Image
    imu: Writes[imu_t] = channel("r/seen")

    def loop(self) -> None:
        self.imu.write()

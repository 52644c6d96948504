"""A component that computes, and one that takes too much memory or crashes."""

import ctypes
from pathlib import Path

import numpy as np

from fwk import Component, Config, Reads, Writes
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t

_taken: list[object] = []


def long_sum(number: int) -> float:
    return float(sum(each * each for each in range(number)))


class Worker(Component):
    """Uses processor time."""

    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += long_sum(3000)
        self.imu.write()


class GluttonConfig(Config):
    array_mb: int = 0
    """Taken and kept in each iteration, in one piece."""
    objects: int = 0
    """Taken and kept in each iteration."""
    crash_tick: int = 0
    """Tick in which its first incarnation crashes."""


class Glutton(Component):
    """Uses memory, or crashes."""

    stage = "think"
    reaches_outside = False
    config: GluttonConfig
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        tick = self.imu.value.header.tick
        if tick == self.config.crash_tick and not Path("crashed").exists():
            Path("crashed").touch()
            ctypes.string_at(0)
        if self.config.array_mb:
            _taken.append(np.ones(self.config.array_mb << 20, np.uint8))
        _taken.extend([object()] for _ in range(self.config.objects))
        self.pose.value.x_m = float(tick)
        self.pose.write()

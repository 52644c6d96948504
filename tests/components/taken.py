"""A driver that takes the main loop, a rival that also requests it, and two players."""

import os
import signal
from pathlib import Path

from fwk import Clock, Component, Config, Each, MainLoop, Reads, Writes, channel
from lcmtypes.robot import imu_t


class DriverConfig(Config):
    first: int = 5
    last: int = 12
    order: list[str] = ["act", "think", "act", "act", "sensor_acquire"]
    dies: int = 0


class Player(Component):
    """Sums up what it hears."""

    stage = "act"
    all: Each[Reads[imu_t]] = channel("*/imu")
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1 + sum(
            message.header.sequence for reader in self.all.values() for message in reader.fresh
        )
        self.imu.write()


class Driver(Player):
    """Holds the main loop from one tick to another."""

    stage = "think"
    reaches_outside = False
    clock: Clock
    config: DriverConfig
    main_loop: MainLoop

    def loop(self) -> None:
        super().loop()
        self.imu.value.heading_rad += 1000 * self.main_loop.mine + 10 * bool(self.main_loop.holder)
        if self.clock.tick == self.config.first:
            self.main_loop.take_over(self.config.order)
        if self.clock.tick == self.config.last:
            self.main_loop.give_back()
        if self.clock.tick == self.config.dies and not Path("died").exists():
            Path("died").touch()
            os.kill(os.getpid(), signal.SIGKILL)

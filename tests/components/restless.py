"""A counter, a slow continuous planner, and a follower of the planner."""

import os
from pathlib import Path

import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Clock, Component, Config, MainLoop, Reads, Writes, channel
from fwk.clock import monotonic_us, sleep_s
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class Counter(Component):
    """Counts its iterations."""

    stage = "think"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1
        self.imu.write()


class PlannerConfig(Config):
    takes_s: float = 0.02
    gain: float = 1.0
    takes_loop: int = 0


def note_time() -> None:
    """Appends the wall time in microseconds to the file `times`; no message depends on it."""
    with Path("times").open("a") as file:
        file.write(f"{monotonic_us()}\n")


class Planner(Component):
    """Sums up everything it hears."""

    rate_hz = 0
    reaches_outside = False
    clock: Clock
    config: PlannerConfig
    main_loop: MainLoop
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def init(self) -> None:
        Path("planner.pid").write_text(str(os.getpid()))
        note_time()

    def loop(self) -> None:
        note_time()
        before = [message.header.sequence for message in self.imu.fresh]
        sleep_s(self.config.takes_s)
        assert before == [message.header.sequence for message in self.imu.fresh]
        self.pose.value.x_m += self.config.gain * sum(before)
        self.pose.value.y_m = before[0] if before else 0
        self.pose.value.heading_rad = before[-1] if before else 0
        self.pose.write()
        Path("planned").write_text(str(self.pose.value.header.sequence))
        number, first = self.pose.value.header.sequence, self.config.takes_loop
        if first and number == first:
            self.main_loop.take_over(["think", "think", "act"])
        if first and number > first + 4 and self.main_loop.mine:
            self.main_loop.give_back()


class Follower(Component):
    """Sums up the planner's messages."""

    stage = "act"
    pose: Reads[pose_t]
    imu: Writes[imu_t] = channel("r/followed")

    def loop(self) -> None:
        self.imu.value.heading_rad += sum(message.x_m for message in self.pose.fresh)
        self.imu.write()

"""A planner with a rate of its own, and a follower that hears the planner and programs outside."""

import zlib

import numpy as np

from fwk import Component, Config, Each, Reads, Writes, channel
from fwk.clock import sleep_s
from lcmtypes.play import note_t
from lcmtypes.robot import imu_t, motor_command_t


class PlannerConfig(Config):
    takes_s: float = 0.01
    """Duration of a plan."""
    gain: float = 1.0
    """Part of each plan."""


class Planner(Component):
    """Plans from everything it hears, as often as it can."""

    rate_hz = 0
    config: PlannerConfig
    rng: np.random.Generator
    notes: Each[Reads[note_t]] = channel("*/note")
    plan: Writes[imu_t]

    def init(self) -> None:
        self.digest = 0

    def loop(self) -> None:
        for _, reader in self.notes.items():
            for note in reader.fresh:
                self.digest = zlib.crc32(note.encode(), self.digest)
        sleep_s(self.config.takes_s)
        self.plan.value.heading_rad = self.config.gain * self.digest + float(self.rng.random())
        self.plan.write()

    def finalize(self) -> None:
        self.plan.value.heading_rad = -self.config.gain
        self.plan.write()


class Follower(Component):
    """Sums up plans and outside messages; reports its total and its settings in `finalize`."""

    stage = ("sensor_process", "act")
    config: PlannerConfig
    plan: Reads[imu_t] = channel("z/plan")
    wish: Reads[motor_command_t] = channel("r/wish", history=3)
    way: Writes[imu_t]

    def loop(self) -> None:
        self.way.value.heading_rad += sum(each.heading_rad for each in self.plan.fresh)
        self.way.value.heading_rad += self.config.gain * sum(each.vx_m_s for each in self.wish.history)
        self.way.write()

    def finalize(self) -> None:
        self.way.value.heading_rad += self.config.gain
        self.way.write()

"""Requests more channels at once than the plan has spare, and reports the outcome."""

import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Blackboard, Component, Config, Writes
from lcmtypes.robot import imu_t


class GreedyConfig(Config):
    text: str = "x" * 10_000
    gain: float = 0.0


class Greedy(Component):
    stage = "think"
    blackboard: Blackboard
    config: GreedyConfig
    imu: Writes[imu_t]

    def init(self) -> None:
        names = [f"a_channel_whose_name_is_rather_long_number_{number}" for number in range(64)]
        self.asked = [self.blackboard.open_for_writing(imu_t, name) for name in names]

    def loop(self) -> None:
        answered = sum(each.is_open or each.refused != "" for each in self.asked)
        self.imu.value.heading_rad = answered + self.config.gain
        self.imu.write()

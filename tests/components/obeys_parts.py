"""A component that obeys messages from outside."""

import os
from pathlib import Path

import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Clock, Component, Reads, Writes, channel
from lcmtypes.robot import imu_t, motor_command_t


class Obeys(Component):
    """Sums up all outside messages, and the newest three."""

    stage = ("think", "act")
    reaches_outside = False
    clock: Clock
    wish: Reads[motor_command_t] = channel(history=3)
    total: Writes[imu_t]
    recent: Writes[imu_t]

    def init(self) -> None:
        Path("obeys.pid").write_text(str(os.getpid()))

    def loop(self) -> None:
        self.total.value.heading_rad += sum(each.vx_m_s for each in self.wish.fresh)
        self.total.write()
        self.recent.value.heading_rad = sum(each.vx_m_s for each in self.wish.history)
        self.recent.write()

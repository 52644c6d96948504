"""A small system that programs outside take part in: one that obeys a joystick, in what it writes everything counts."""

from tests.programs.orchestra import WEATHER

PARTS = '''
"""Obeys."""

import os
from pathlib import Path

import weather
from fwk import Clock, Component, Reads, Writes, channel
from lcmtypes.robot import imu_t, motor_command_t


class Obeys(Component):
    """Adds up what is wished, all of it and the newest three."""

    stage = ("think", "act")
    clock: Clock
    wish: Reads[motor_command_t] = channel(history=3)
    total: Writes[imu_t]
    recent: Writes[imu_t]

    def init(self):
        Path("obeys.pid").write_text(str(os.getpid()))

    def loop(self):
        self.total.value.heading_rad += sum(each.vx_m_s for each in self.wish.fresh)
        self.total.write()
        self.recent.value.heading_rad = sum(each.vx_m_s for each in self.wish.history)
        self.recent.write()
'''

LAUNCH = """
name: joystick
{time}
components:
  r/obeys: {{ use: "obeys_parts:Obeys" }}
  s/obeys: {{ use: "obeys_parts:Obeys", channels: {{ wish: r/wish }} }}
outside:
  r/wish: robot.motor_command_t
public_url: "{public_url}"
"""


def outside_system(public_url: str, time: str) -> dict[str, str]:
    """The files of a user's folder."""
    return {
        "obeys_parts.py": PARTS,
        "weather.py": WEATHER,
        "joystick.yaml": LAUNCH.format(time=time, public_url=public_url),
    }

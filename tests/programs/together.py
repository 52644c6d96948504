"""Orchestra and lift in one run, in lockstep or real time, with a driver that repeatedly takes the main loop over."""

import re

from tests.harness.components import sources
from tests.programs.command_system import command_system
from tests.programs.orchestra import GROUPS, orchestra

TOGETHER = """
name: together
include: [orchestra.yaml, lift.yaml]
components:
  z/driver: {use: "driver:Driver"}
"""
WALL = """
clock: wall
period_s: 0.05
stage_time_s: 0.03
"""
FILE = "launch/together.yaml"


def together(public_url: str, more: str = "", *, real_time: bool, groups: bool = False) -> dict[str, str]:
    """Returns the files of a user's folder; `more` continues the components of the launch file."""
    files = orchestra(public_url, GROUPS if groups else "") | command_system(public_url)
    text = (TOGETHER.rstrip() + "\n" + more.lstrip("\n")) + (WALL if real_time else "")
    files |= sources("driver.py") | {FILE: text}
    for name in ("launch/orchestra.yaml", "launch/lift.yaml"):
        files[name] = re.sub(r'use: ("[\w.:]+")', r"use: \1, restart: {limit: 100, backoff_s: 0.01}", files[name])
        if real_time:  # wall time instead of the conductor's, and no frames, which are not recorded
            no_source = r"  world/conductor: .*\n|, world/conductor|  a/viewer: .*\n|speed: max\n"
            files[name] = re.sub(no_source, "", files[name])
    return files

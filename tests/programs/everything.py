"""A system in which everything happens at once: orchestra, lift and driver with a planner and programs outside."""

from tests.harness.components import sources
from tests.programs.together import together

MORE = """
  z/planner: {use: "everything_parts:Planner", restart: {limit: 100, backoff_s: 0.01}}
  z/follower: {use: "everything_parts:Follower", restart: {limit: 100, backoff_s: 0.01}}
outside:
  r/wish: robot.motor_command_t
"""


def everything(public_url: str, *, real_time: bool, groups: bool = False) -> dict[str, str]:
    """Returns the files of a user's folder."""
    return together(public_url, MORE, real_time=real_time, groups=groups) | sources("everything_parts.py")

"""A robot that stands still: an obstacle of scenarios."""

from fwk import Component, Writes
from lcmtypes.robot import wheel_command_t


class Dummy(Component):
    """Keeps its wheels still."""

    stage = "act_exec"

    wheel_command: Writes[wheel_command_t]

    def loop(self) -> None:
        self.wheel_command.write()

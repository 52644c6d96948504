"""A robot that stands still: an obstacle of scenarios."""

from fwk import Component, Writes
from lcmtypes.robot import wheel_command_t
from procs.model.kinematics import WHEEL_ANGLES_DEG


class Dummy(Component):
    """Keeps its wheels still."""

    stage = "act_exec"

    wheel_command: Writes[wheel_command_t]

    def loop(self) -> None:
        self.wheel_command.value.wheel_m_s = [0.0] * len(WHEEL_ANGLES_DEG)
        self.wheel_command.write()

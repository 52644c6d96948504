"""The aspect of a log target: the lines of everybody, for a component that does something with them."""

from collections.abc import Sequence

from fwk.component.channels import Reads
from fwk.component.log import LEVELS
from lcmtypes.core import log_t


class LogLines:
    """What components and framework log, whatever the levels of the other targets; its own lines it does not get.

    A line is there from a tick after the one in which it was written on. Lines carry wall time and come when they
    come, so what a component makes of them differs from run to run; a replay gives it the same again.
    """

    def __init__(self, reader: Reads[log_t], component: str) -> None:
        self._reader = reader
        self._component = component

    @property
    def fresh(self) -> Sequence[log_t]:
        """The lines since the last iteration, oldest first."""
        return [line for line in self._reader.fresh if line.component != self._component]

    def of(self, level: str) -> Sequence[log_t]:
        """Those of `fresh` that are of a level or worse: debug, info, warning or error.

        Raises:
            ValueError: there is no such level.
        """
        if level not in LEVELS:
            raise ValueError(f"no level '{level}'; there are {', '.join(LEVELS)}")
        return [line for line in self.fresh if line.level >= LEVELS[level]]

"""The log-target aspect: log lines of the whole run for a component."""

from collections.abc import Sequence

from fwk.component.channels import Reads
from fwk.component.log import LEVELS
from lcmtypes.core import log_t


class LogLines:
    """Log lines of the other components and of the framework, whatever the levels of the other targets.

    A line becomes visible in a tick after the one in which it was written. Lines carry wall time, and their arrival
    depends on it, so a component's use of them differs between runs; a replay gives it the same lines again.
    """

    def __init__(self, reader: Reads[log_t], component: str) -> None:
        self._reader = reader
        self._component = component

    @property
    def fresh(self) -> Sequence[log_t]:
        """Lines since the last iteration, oldest first."""
        return [line for line in self._reader.fresh if line.component != self._component]

    def of(self, level: str) -> Sequence[log_t]:
        """Returns the lines of `fresh` of at least a level: debug, info, warning or error.

        Raises:
            ValueError: there is no such level.
        """
        if level not in LEVELS:
            raise ValueError(f"no level '{level}'; the levels are {', '.join(LEVELS)}")
        return [line for line in self.fresh if line.level >= LEVELS[level]]

"""CPU and memory of the processes of a run, read by the console itself: the run does nothing for it."""

from collections.abc import Iterable
from typing import NamedTuple

import psutil

_MEGABYTE = 1 << 20


class Figures(NamedTuple):
    """Figures of a process."""

    cpu_percent: float
    """CPU time since the last measurement, in percent of one core."""
    memory_mb: float


class Usage:
    """Measures processes again and again."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def measure(self, pids: Iterable[int]) -> dict[int, Figures]:
        """Returns the figures of the processes that exist."""
        wanted = {pid for pid in pids if pid}
        self._known = {pid: process for pid, process in self._known.items() if pid in wanted}
        found = {}
        for pid in wanted:
            try:
                process = self._known.setdefault(pid, psutil.Process(pid))
                found[pid] = Figures(process.cpu_percent(), process.memory_info().rss / _MEGABYTE)
            except psutil.Error:
                self._known.pop(pid, None)
        return found

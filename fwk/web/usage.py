"""CPU and memory of the processes of a run, read by the console itself: the run does nothing for it."""

from collections.abc import Iterable
from typing import NamedTuple

import psutil

from fwk.clock import US_PER_S, wall_us

_MEGABYTE = 1 << 20
_LEAST_S = 0.01


class Figures(NamedTuple):
    """Figures of a process."""

    cpu_percent: float
    """CPU time since the last measurement, in percent of one core; at first that since the process began."""
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
                process = self._known.get(pid) or psutil.Process(pid)
                cpu_percent = process.cpu_percent()
                if pid not in self._known:
                    cpu_percent = _mean_percent(process)
                self._known[pid] = process
                found[pid] = Figures(cpu_percent, process.memory_info().rss / _MEGABYTE)
            except psutil.Error:
                self._known.pop(pid, None)
        return found


def _mean_percent(process: psutil.Process) -> float:
    """Returns the CPU time of a process since it began, in percent of one core."""
    times = process.cpu_times()
    awake_s = max(_LEAST_S, wall_us() / US_PER_S - process.create_time())
    return float(100.0 * (times.user + times.system) / awake_s)

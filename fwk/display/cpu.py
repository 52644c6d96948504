"""CPU time of the processes of a run, from /proc."""

import os
from collections.abc import Iterable

from fwk.clock import US_PER_S, monotonic_us

_TICKS_PER_S = os.sysconf("SC_CLK_TCK")
_PERIOD_US = US_PER_S


class CpuMeter:
    """Measures how much of a core each process uses, once a second."""

    def __init__(self) -> None:
        self._before: dict[int, float] = {}
        self._measured_us = 0
        self.percent: dict[int, float] = {}
        """Process number to percent of one core; processes seen once have no entry."""

    def measure(self, pids: Iterable[int]) -> None:
        """Measures, if a second has passed since the last time."""
        now_us = monotonic_us()
        if now_us < self._measured_us + _PERIOD_US:
            return
        elapsed_s = (now_us - self._measured_us) / US_PER_S
        used = {pid: seconds for pid in pids if pid and (seconds := cpu_s(pid)) is not None}
        self.percent = {
            pid: 100 * (seconds - self._before[pid]) / elapsed_s for pid, seconds in used.items() if pid in self._before
        }
        self._before, self._measured_us = used, now_us


def cpu_s(pid: int) -> float | None:
    """Returns the CPU time that a process has used, in seconds; None if it has ended."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            fields = file.read().rpartition(b")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _TICKS_PER_S
    except (OSError, ValueError, IndexError):
        return None

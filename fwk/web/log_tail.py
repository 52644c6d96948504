"""The newest lines of the logs of runs, kept for all browsers."""

import threading
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.logs.json_lines import FILE
from fwk.logs.reader import read_lines

LINES_MAX = 5000
_UNUSED_S = 30.0


class LogTail:
    """Follows one log in a thread of its own as long as pages look at it; lines are numbered from 1."""

    def __init__(self, folder: Path, now_us: Callable[[], int] = monotonic_us) -> None:
        self._now_us = now_us
        self._lines: deque[tuple[int, dict[str, Any]]] = deque(maxlen=LINES_MAX)
        self._lock = threading.Lock()
        self._asked_us = now_us()
        self._thread = threading.Thread(target=self._follow, args=(folder / FILE,), daemon=True)
        self._thread.start()

    @property
    def follows(self) -> bool:
        """Whether new lines still arrive."""
        return self._thread.is_alive()

    def after(self, number: int) -> list[tuple[int, dict[str, Any]]]:
        """Returns the kept lines with a higher number."""
        self._asked_us = self._now_us()
        with self._lock:
            if not self._lines or self._lines[-1][0] <= number:
                return []
            return [each for each in self._lines if each[0] > number]

    def _follow(self, file: Path) -> None:
        try:
            for number, line in enumerate(read_lines(file, self._wanted), 1):
                with self._lock:
                    self._lines.append((number, line))
        except OSError:
            return  # the run has no log (yet); the next page that asks starts again

    def _wanted(self) -> bool:
        return self._now_us() < self._asked_us + _UNUSED_S * US_PER_S


class LogTails:
    """The logs that pages look at, by run directory."""

    def __init__(self) -> None:
        self._tails: dict[str, LogTail] = {}

    def of(self, run_dir: str) -> LogTail:
        """Returns the log of a run."""
        tail = self._tails.get(run_dir)
        if tail is None or not tail.follows:
            self._tails = {name: each for name, each in self._tails.items() if each.follows}
            tail = self._tails[run_dir] = LogTail(Path(run_dir))
        return tail

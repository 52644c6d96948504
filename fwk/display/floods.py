"""Groups equivalent log lines, so that a flood of them does not hide all others."""

import re
from collections import deque
from collections.abc import Iterator
from copy import copy

from fwk.clock import US_PER_S
from lcmtypes.core import log_t

WINDOW_US = 2 * US_PER_S
"""Wall time in which equivalent lines are one group."""
_WARNING_WINDOW_US = 60 * US_PER_S
"""The same for warnings on the live display, where a warning every few seconds would displace all other lines."""
PRINTED_MAX = 4
"""Number of lines of a group that are printed; the others are counted."""
_VARYING = re.compile(r"(?<![\w.-])[\w.-]++/[\w./-]+|\d+(?:\.\d+)?")
"""Names and numbers. A name is looked for at the beginning of a word only, so that long words take no longer."""


class LineGroup:
    """A log line and the number of lines that are equivalent to it."""

    def __init__(self, line: log_t) -> None:
        self.line = line
        """Newest line of the group."""
        self.meaning = line.level, _VARYING.sub("*", line.text)
        """Level and text without names of components and numbers."""
        self.count = 1
        self.since_us = 0
        """Begin of the group, in monotonic wall time."""
        self.printed = 1

    @property
    def text(self) -> str:
        """Returns the text with the number of lines, if there are several."""
        return f"{self.line.text} (and {self.count - 1} like it)" if self.count > 1 else str(self.line.text)


class LineGroups:
    """Groups of the last lines of a log, the newest last."""

    def __init__(self, kept: int) -> None:
        self._groups: deque[LineGroup] = deque(maxlen=kept)

    def __iter__(self) -> Iterator[LineGroup]:
        return iter(self._groups)

    def add(self, line: log_t) -> LineGroup:
        """Adds a line to the group of its meaning, or begins one; returns the group."""
        window_us = _WARNING_WINDOW_US if line.level == log_t.WARNING else WINDOW_US
        made = LineGroup(line)
        for group in reversed(self._groups):
            if line.wall_us - group.line.wall_us > window_us:
                break
            if group.meaning == made.meaning:
                group.line, group.count = line, group.count + 1
                self._groups.remove(group)
                self._groups.append(group)
                return group
        self._groups.append(made)
        return made


class FloodGate:
    """Lets the first of equivalent lines pass, counts the others, and reports their number later."""

    def __init__(self) -> None:
        self._groups: dict[tuple[int, str], LineGroup] = {}

    def passes(self, line: log_t, now_us: int) -> bool:
        """Tells whether to print a line that came at `now_us` of monotonic wall time."""
        made = LineGroup(line)
        group = self._groups.setdefault(made.meaning, made)
        if group is made:
            made.since_us = now_us
            return True
        group.line, group.count = line, group.count + 1
        if group.printed < PRINTED_MAX:
            group.printed += 1
            return True
        return False

    def held_back(self, now_us: int) -> list[tuple[log_t, int]]:
        """Returns, once for each group that has ended, its last line and how many lines were not printed."""
        ended = [key for key, group in self._groups.items() if now_us - group.since_us > WINDOW_US]
        groups = [self._groups.pop(key) for key in ended]
        return [(group.line, group.count - group.printed) for group in groups if group.count > group.printed]


class Tracebacks:
    """Shortens tracebacks that were printed before: a failure that repeats with each restart needs one."""

    def __init__(self) -> None:
        self._printed: set[tuple[str, str]] = set()

    def shortened(self, line: log_t) -> log_t:
        """Returns the line, or a copy with the last line of its traceback if the component has printed the same one."""
        first, _, trace = line.text.partition("\n")
        if not trace.startswith("Traceback "):
            return line
        if (line.component, trace) not in self._printed:
            self._printed.add((line.component, trace))
            return line
        short = copy(line)
        short.text = f"{first}: {trace.splitlines()[-1]}, with the same traceback as before"
        return short

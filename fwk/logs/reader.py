"""Reads the text log for programs of a run and selects lines from it."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fwk.component.log import LEVELS, TIME_MAX_US
from fwk.logs.rotating import read_rotating
from fwk.model.selection import matches
from lcmtypes.core import log_t


@dataclass(frozen=True)
class Filter:
    """Selection of lines; a field that is None selects all."""

    level: str | None = None
    """Least level."""
    component: str | None = None
    """Name or pattern of the component."""
    tick: tuple[int, int] | None = None
    """First and last tick."""
    time_us: tuple[int, int] | None = None
    """First and last logical time, in seconds."""
    file: str | None = None
    """Name of the source file, with any number of its folders."""
    line: int | None = None
    text: re.Pattern[str] | None = None
    """Pattern found anywhere in the text."""
    since_us: int | None = None
    """First wall time since the epoch."""
    until_us: int | None = None
    """Last wall time since the epoch."""

    def wants(self, line: dict[str, Any]) -> bool:
        """Returns whether a line is selected."""
        return (
            (self.level is None or LEVELS.get(line["level"], LEVELS["error"]) >= LEVELS[self.level])
            and (self.component is None or matches(line["component"], self.component))
            and (self.tick is None or self.tick[0] <= line["tick"] <= self.tick[1])
            and (self.time_us is None or self.time_us[0] <= line["time_us"] <= self.time_us[1])
            and (self.file is None or f"/{line['file']}".endswith(f"/{self.file}"))
            and (self.line is None or line["line"] == self.line)
            and (self.text is None or self.text.search(line["text"]) is not None)
            and (self.since_us is None or line["wall_us"] >= self.since_us)
            and (self.until_us is None or line["wall_us"] <= self.until_us)
        )


def read_lines(file: Path, goes_on: Callable[[], bool] = lambda: False) -> Iterator[dict[str, Any]]:
    """Yields the lines of a log as dicts of the fields of `core.log_t`; waits for more while `goes_on()` is true.

    Lines that are not such an object, such as the last line of a killed run, are skipped.
    """
    for text in read_rotating(file, goes_on):
        with suppress(ValueError, RecursionError):
            line = json.loads(text)
            if _is_line(line):
                yield line


def _is_line(line: Any) -> bool:
    return (
        isinstance(line, dict)
        and all(isinstance(line.get(name), str) for name in ("level", "component", "file", "text"))
        and all(type(line.get(name)) is int for name in ("tick", "time_us", "wall_us", "line"))
        and 0 <= line["wall_us"] < TIME_MAX_US
        and abs(line["time_us"]) < TIME_MAX_US
    )


def from_plain(line: dict[str, Any]) -> log_t:
    """Returns the message that a line was written from."""
    made = log_t()
    for name in log_t.__slots__:
        setattr(made, name, line[name])
    made.level = LEVELS.get(line["level"], log_t.ERROR)
    return made

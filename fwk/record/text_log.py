"""Reads a run's text log, the one for programs, to its end or for as long as it grows."""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fwk.aspects.logging import LEVELS
from fwk.clock import sleep_s
from fwk.plan.selection import matches
from lcmtypes.core import log_t

_LOOK_S = 0.2


@dataclass(frozen=True)
class Filter:
    """Which lines are wanted; what is None is all the same."""

    level: str | None = None
    """This one and worse."""
    component: str | None = None
    """Name or pattern."""
    tick: tuple[int, int] | None = None
    """First and last."""
    file: str | None = None
    line: int | None = None
    text: str | None = None
    """Part of the text, in capitals or not."""
    since_us: int | None = None
    """Wall time since the epoch."""

    def wants(self, line: dict[str, Any]) -> bool:
        """Whether a line is wanted."""
        return (
            (self.level is None or LEVELS.get(line["level"], LEVELS["error"]) >= LEVELS[self.level])
            and (self.component is None or matches(line["component"], self.component))
            and (self.tick is None or self.tick[0] <= line["tick"] <= self.tick[1])
            and (self.file is None or line["file"] == self.file)
            and (self.line is None or line["line"] == self.line)
            and (self.text is None or self.text.lower() in line["text"].lower())
            and (self.since_us is None or line["wall_us"] >= self.since_us)
        )


def read_lines(file: Path, goes_on: Callable[[], bool] = lambda: False) -> Iterator[dict[str, Any]]:
    """The lines of a log as dicts of the fields of `core.log_t`; waits for more as long as `goes_on()` is true.

    A line that a killed run left unfinished is passed over.
    """
    rest = ""
    with open(file, encoding="utf-8", errors="replace") as opened:
        while True:
            running = goes_on()  # asked first, so that nothing written meanwhile is missed
            *whole, rest = (rest + opened.read()).split("\n")
            for text in whole:
                try:
                    yield json.loads(text)
                except ValueError:
                    continue
            if not running:
                return
            sleep_s(_LOOK_S)


def from_plain(line: dict[str, Any]) -> log_t:
    """The message that a line was written from."""
    made = log_t()
    for name in log_t.__slots__:
        setattr(made, name, line[name])
    made.level = LEVELS.get(line["level"], log_t.ERROR)
    return made

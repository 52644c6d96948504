"""The targets of a plan's log lines, each with its lowest level."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from fwk.component.log import LEVELS, Logger
from fwk.gateway.connections import Sink
from fwk.logs import json_lines as json_log
from fwk.logs import text_file as text_log
from fwk.logs.component_target import LogTarget
from fwk.logs.json_lines import JsonLog
from fwk.logs.rotating import RotatingFile
from fwk.logs.syslog import Syslog
from fwk.logs.text_file import TextLog
from fwk.model.names import LINES
from fwk.model.plan import Plan
from fwk.model.sections import LogPlan

_MB = 1_000_000
_LEVEL_AT = 8  # of an encoded log_t, after the type's fingerprint
OFF = "off"


class Above:
    """Sink that gives another sink the lines of text of one level and worse, and all other messages."""

    def __init__(self, sink: Sink, level: int) -> None:
        self._sink = sink
        self._level = level
        self.tick = sink.tick
        self.close = sink.close

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Passes a message on unless it is a line below the level."""
        if channel != "fwk/log" or data[_LEVEL_AT] >= self._level:
            self._sink.message(channel, data, time_us)


def above(sink: Sink, level: str) -> Sink:
    """Returns the sink itself if it gets all lines, otherwise a filter before it."""
    if level == "debug":
        return sink
    return Above(sink, LEVELS.get(level, max(LEVELS.values()) + 1))


def syslog(log: LogPlan, run: str, report: Callable[[str], None]) -> list[Sink]:
    """Returns the sink for syslog, if the plan wants it."""
    return [] if log.syslog == OFF else [above(Syslog(log.syslog_to, run, report), log.syslog)]


def components(plan: Plan, take_in: Callable[[str, Any], int], log: Logger) -> list[Sink]:
    """Returns the sink for components with the aspect `LogLines`, if there are any."""
    wanted = any(channel.name == LINES for channel in plan.channels)
    return [LogTarget(take_in, log)] if wanted else []


def files(log: LogPlan, folder: Path, report: Callable[[str], None]) -> list[Sink]:
    """Returns the sinks for the text log for people and that for programs, if the plan wants them."""

    def file(name: str) -> RotatingFile:
        return RotatingFile(folder / name, round(log.file_mb * _MB), log.files, report)

    wanted: list[Sink] = []
    if log.file != OFF:
        wanted.append(above(TextLog(file(text_log.FILE)), log.file))
    if log.json_lines != OFF:
        wanted.append(above(JsonLog(file(json_log.FILE)), log.json_lines))
    return wanted

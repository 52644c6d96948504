"""Values of a log over time: what `CHANNEL.FIELD` names."""

import re
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from fwk.clock import US_PER_S
from fwk.lcm.event_log import LogError
from fwk.lcm.messages import type_name
from fwk.lcm.type_registry import MessageType
from fwk.log_tools.columns import Column, columns_of
from fwk.log_tools.cut import Progress
from fwk.log_tools.messages_of import Messages
from fwk.log_tools.selection import Selection
from fwk.model.errors import hint
from fwk.recording.log_contents import Note, note_in

_UNITS = ("m_s2", "m_s", "rad_s2", "rad_s", "m2", "m", "rad", "us", "s", "px", "hz", "v", "a", "n", "kg")
_SHOWN = {"m_s2": "m/s²", "m_s": "m/s", "rad_s2": "rad/s²", "rad_s": "rad/s", "m2": "m²", "hz": "Hz", "us": "µs"}


@dataclass
class Series:
    """Values of one field of one channel."""

    label: str
    """Channel and field: `cyan1/odometry.x_m`."""
    unit: str
    """Unit, from the end of the field's name; empty: none."""
    times_s: list[float] = field(default_factory=list)
    """Time stamps in the log, from the beginning of a log that does not count logical time."""
    values: list[float] = field(default_factory=list)


class Wanted(NamedTuple):
    """Channels and field that a path such as `cyan*/odometry.x_m` names."""

    channel: str
    """Name or pattern."""
    field: str


def wanted(path: str) -> Wanted:
    """Splits a path into channel and field.

    Raises:
        LogError: the path has no field.
    """
    namespace, slash, last = path.rpartition("/")
    name, dot, member = last.partition(".")
    if not (name and dot and member):
        raise LogError(f"'{path}' is not a field of a channel; use CHANNEL.FIELD, such as cyan1/odometry.x_m")
    return Wanted(namespace + slash + name, member)


def unit_of(name: str) -> str:
    """Returns the unit at the end of a field's name: `m/s` for `vx_m_s`; empty: none."""
    last = re.sub(r"(\.\d+)+$", "", name).rpartition(".")[2]
    found = next((unit for unit in _UNITS if last.endswith(f"_{unit}")), "")
    return _SHOWN.get(found, found)


class SeriesOf:
    """Collects the series that paths name, from the messages of a log or a run.

    Args:
        source: the log or the run, for messages.
        paths: fields such as `cyan1/odometry.x_m`; the channel may be a pattern.

    Raises:
        LogError: a path has no field.
    """

    def __init__(self, source: str, paths: Sequence[str]) -> None:
        self._source = source
        self._sought = [wanted(path) for path in paths]
        self._found: dict[tuple[int, str], Series] = {}
        self._columns: dict[tuple[int, str, MessageType], Column] = {}
        self._places: dict[str, list[int]] = {}

    @property
    def series(self) -> list[Series]:
        """The series so far, in the order of the paths."""
        return [self._found[key] for key in sorted(self._found)]

    def is_sought(self, channel: str) -> bool:
        """Returns whether a path names the channel."""
        if channel not in self._places:
            found = [channel == pattern or fnmatchcase(channel, pattern) for pattern, _ in self._sought]
            self._places[channel] = [place for place, is_found in enumerate(found) if is_found]
        return bool(self._places[channel])

    def add(self, channel: str, kind: MessageType, message: Any, time_s: float) -> None:
        """Adds the values of a message.

        Raises:
            LogError: a path names a field that is not a number of the message.
        """
        for place in self._places[channel] if self.is_sought(channel) else ():
            key = place, channel, kind
            if key not in self._columns:
                name = self._sought[place].field
                self._columns[key] = _column(self._source, channel, kind, name)
                self._found.setdefault((place, channel), Series(f"{channel}.{name}", unit_of(name)))
            series = self._found[place, channel]
            series.times_s.append(time_s)
            series.values.append(float(self._columns[key].value(message)))

    def forget(self, before_s: float) -> None:
        """Removes the values before a time."""
        for series in self._found.values():
            kept = bisect_left(series.times_s, before_s)
            del series.times_s[:kept], series.values[:kept]

    def check(self) -> None:
        """Checks that each path has named a channel.

        Raises:
            LogError: one has not.
        """
        for place, (pattern, _) in enumerate(self._sought):
            if not any(index == place for index, _ in self._found):
                raise LogError(f"{self._source}: no channel matches '{pattern}'; {hint(pattern, self._places)}")


def series_in(log: Path, paths: Sequence[str], progress: Progress = lambda _: None) -> tuple[list[Series], list[Note]]:
    """Returns the series that the paths name, in their order, and the bookmarks of the log.

    Raises:
        LogError: the log cannot be read, a path names no number of it, or no channel.
    """
    made = SeriesOf(str(log), paths)
    notes: list[Note] = []
    zero_us: int | None = None
    for each in Messages(log, Selection(), progress):
        channel = each.event.channel
        if zero_us is None:
            zero_us = 0 if channel.startswith("fwk/") else each.event.time_us
        if note := note_in(channel, each.event.data):
            notes.append(note)
        made.add(channel, each.kind, each.message, (each.event.time_us - zero_us) / US_PER_S)
    made.check()
    return made.series, notes


def _column(source: str, channel: str, kind: MessageType, name: str) -> Column:
    """Returns the column of a field that holds numbers.

    Raises:
        LogError: the type has no such field, or it holds no number.
    """
    known = {column.name: column for column in columns_of(kind)}
    if name not in known:
        raise LogError(f"{source}: {channel}: no field '{name}' in {type_name(kind)}; {hint(name, known)}")
    column = known[name]
    if column.dimensions or column.kind == "string":
        what = "a list" if column.dimensions else "a text"
        raise LogError(f"{source}: {channel}.{name} is {what}, not a number; `fwk export` writes it to a table")
    return column

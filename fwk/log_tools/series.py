"""Values of a log over time: what `CHANNEL.FIELD` names."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

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


def series_in(log: Path, paths: Sequence[str], progress: Progress = lambda _: None) -> tuple[list[Series], list[Note]]:
    """Returns the series that the paths name, in their order, and the bookmarks of the log.

    Raises:
        LogError: the log cannot be read, a path names no number of it, or no channel.
    """
    sought = [wanted(path) for path in paths]
    messages = Messages(log, Selection(), progress)
    found: dict[tuple[int, str], Series] = {}
    columns: dict[tuple[int, str, MessageType], Column] = {}
    seen: dict[str, None] = {}
    notes: list[Note] = []
    zero_us: int | None = None
    for each in messages:
        channel, kind = each.event.channel, each.kind
        if zero_us is None:
            zero_us = 0 if channel.startswith("fwk/") else each.event.time_us
        if channel not in seen:
            seen[channel] = None
        if note := note_in(channel, each.event.data):
            notes.append(note)
        for place, (pattern, name) in enumerate(sought):
            if not (channel == pattern or fnmatchcase(channel, pattern)):
                continue
            key = place, channel, kind
            if key not in columns:
                columns[key] = _column(log, channel, kind, name)
                found.setdefault((place, channel), Series(f"{channel}.{name}", unit_of(name)))
            series = found[place, channel]
            series.times_s.append((each.event.time_us - zero_us) / US_PER_S)
            series.values.append(float(columns[key].value(each.message)))
    for place, (pattern, _) in enumerate(sought):
        if not any(index == place for index, _ in found):
            raise LogError(f"{log}: no channel matches '{pattern}'; {hint(pattern, seen)}")
    return [found[key] for key in sorted(found)], notes


def _column(log: Path, channel: str, kind: MessageType, name: str) -> Column:
    """Returns the column of a field that holds numbers.

    Raises:
        LogError: the type has no such field, or it holds no number.
    """
    known = {column.name: column for column in columns_of(kind)}
    if name not in known:
        raise LogError(f"{log}: {channel}: no field '{name}' in {type_name(kind)}; {hint(name, known)}")
    column = known[name]
    if column.dimensions or column.kind == "string":
        what = "a list" if column.dimensions else "a text"
        raise LogError(f"{log}: {channel}.{name} is {what}, not a number; `fwk export` writes it to a table")
    return column

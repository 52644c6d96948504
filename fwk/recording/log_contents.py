"""Contents of a log: types, counts, rates, ticks, gaps and undecodable messages of each channel, and its bookmarks."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar, NamedTuple

from fwk.clock import US_PER_S
from fwk.lcm import envelope
from fwk.lcm.event_log import Event
from fwk.lcm.messages import HEADER_SIZE, Header, type_name
from fwk.lcm.type_registry import decoded, header_of, types_of
from fwk.model.names import NOTE
from fwk.recording.missing_parts import MissingParts
from fwk.recording.versions import EXCERPT
from lcmtypes.core import excerpt_t, log_t

LOG_LINES = "fwk/log"
"""Channel of log lines."""
_OLD_FILES = ("fwk/supervisor/control.py", "fwk/supervisor/control/control.py")
"""Source files from which `fwk note` wrote its lines before they were marked as notes."""
_NO_NOTE = re.compile(r"asked to |cannot answer |[^ ]+: process \d+, ")
"""Beginnings of the other lines from there."""
_MARKS = (NOTE.encode(), b"/control.py")


class Note(NamedTuple):
    """Bookmark of a recording: a line of `fwk note`."""

    tick: int
    time_us: int
    """Logical time."""
    text: str


class ChangedBytes(NamedTuple):
    """Part of a log that is not what was written, according to the check sums of its index."""

    first: int
    """Position of the first byte in the file."""
    last: int
    first_tick: int
    last_tick: int
    missing: bool
    """Whether the file ends before the last byte."""

    def __str__(self) -> str:
        state = "are missing" if self.missing else "are not the bytes that were written"
        return f"bytes {self.first} to {self.last} (ticks {self.first_tick} to {self.last_tick}) {state}"


@dataclass
class ChannelInfo:
    """One channel of a log."""

    types: list[str] = field(default_factory=list)
    """Types by fingerprint, in order of appearance; `a or b`: LCM cannot tell these apart."""
    writers: list[str] = field(default_factory=list)
    messages: int = 0
    bytes: int = 0
    first_us: int = 0
    last_us: int = 0
    """Time stamps of the first and last event."""
    first_tick: int | None = None
    last_tick: int | None = None
    """None: the messages have no header."""
    lost: int = 0
    """Sequence numbers below the highest that the log lacks."""
    gaps: list[tuple[int, int]] = field(default_factory=list)
    """First and last sequence number of the first few gaps."""
    repeated: int = 0
    """Messages whose sequence number is not above all before it: sent again, or out of order."""
    undecodable: int = 0
    """Messages of no known type, or that do not decode."""
    _highest: int = field(default=0, compare=False)

    GAPS_SHOWN: ClassVar = 5

    @property
    def rate_hz(self) -> float:
        """Messages per second by the time stamps of the log; 0 if all have the same time."""
        span_us = self.last_us - self.first_us
        return (self.messages - 1) * US_PER_S / span_us if span_us > 0 else 0.0

    def add(self, event: Event) -> None:
        """Counts a message of the channel."""
        self.first_us = event.time_us if not self.messages else min(self.first_us, event.time_us)
        self.last_us = event.time_us if not self.messages else max(self.last_us, event.time_us)
        self.messages += 1
        self.bytes += len(envelope.content(event.data) if event.in_envelope else event.data)
        name = type_names(event.data, event.in_envelope)
        if name not in self.types:
            self.types.append(name)
        try:
            decoded(event.data)
        except Exception:  # unknown type, or any error of generated code on broken bytes
            self.undecodable += 1
        else:
            if head := whole_header(event.data):
                self._take(head)

    def _take(self, head: Header) -> None:
        if head.writer not in self.writers:
            self.writers.append(head.writer)
        if head.sequence <= self._highest:
            self.repeated += 1
            return
        if self.first_tick is not None and head.sequence > self._highest + 1:
            self.lost += head.sequence - self._highest - 1
            if len(self.gaps) < self.GAPS_SHOWN:
                self.gaps.append((self._highest + 1, head.sequence - 1))
        self._highest = head.sequence
        self.first_tick = head.tick if self.first_tick is None else min(self.first_tick, head.tick)
        self.last_tick = head.tick if self.last_tick is None else max(self.last_tick, head.tick)


@dataclass
class LogInfo:
    """A whole log."""

    file: Path
    size_bytes: int = 0
    events: int = 0
    first_us: int = 0
    last_us: int = 0
    dropped: int = 0
    """Events that the writer of the log counted but did not write: its disk was full, or it could not keep up."""
    damaged_bytes: int = 0
    notes: list[Note] = field(default_factory=list)
    """Bookmarks, in their order."""
    excerpt: str = ""
    """Part of a recording that the log is; empty: a whole recording, or a log of another program."""
    from_index: bool = False
    """Whether the log was not read: numbers of lost messages have no places, and no message was decoded."""
    changed: list[ChangedBytes] = field(default_factory=list)
    """Parts that are not what was written; only if the log has an index and was read."""
    missing: list[MissingParts] = field(default_factory=list)
    """Files that are missing between others."""
    channels: dict[str, ChannelInfo] = field(default_factory=dict)
    """By name, in order of names."""

    @property
    def duration_s(self) -> float:
        """Time from the earliest to the latest event in seconds, by the time stamps of the log."""
        return (self.last_us - self.first_us) / US_PER_S

    @property
    def ticks(self) -> tuple[int, int] | None:
        """First and last tick of all channels; None: no message has a header."""
        firsts = [made.first_tick for made in self.channels.values() if made.first_tick is not None]
        lasts = [made.last_tick for made in self.channels.values() if made.last_tick is not None]
        return (min(firsts), max(lasts)) if firsts else None


def type_names(data: bytes, in_envelope: bool = False) -> str:
    """Returns the types that a message may have: `a or b`, or `unknown` with its fingerprint."""
    mark = envelope.marked(data[:8]) if in_envelope else data[:8]
    return " or ".join(map(type_name, types_of(data))) or f"unknown {mark.hex()}"


def whole_header(data: bytes) -> Header | None:
    """Returns the header of a message; None if it has none, or is too short for one."""
    return header_of(data) if len(data) >= HEADER_SIZE else None


def excerpt_in(channel: str, data: bytes) -> str:
    """Returns the words of the message that says which part of a recording a log is; empty for other messages."""
    try:
        return str(excerpt_t.decode(data).text) if channel == EXCERPT else ""
    except Exception:  # any error of generated code on broken bytes
        return ""


def note_in(channel: str, data: bytes) -> Note | None:
    """Returns the bookmark that a message is; None for other messages."""
    if channel != LOG_LINES or not any(mark in data for mark in _MARKS):
        return None
    try:
        line = log_t.decode(data)
    except Exception:  # any error of generated code on broken bytes
        return None
    is_note = line.file == NOTE or (line.file in _OLD_FILES and not _NO_NOTE.match(line.text))
    return Note(line.tick, line.time_us, line.text) if is_note else None

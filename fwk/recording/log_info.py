"""Contents of a log: types, counts, rates, ticks, gaps and undecodable messages of each channel."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from fwk.clock import US_PER_S
from fwk.lcm import envelope
from fwk.lcm.event_log import Event, LogError
from fwk.lcm.messages import HEADER_SIZE, Header, type_name
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import decoded, header_of, types_of


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
    _highest: int = 0

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
        self.bytes += len(event.data)
        found = types_of(event.data)
        mark = envelope.marked(event.data[:8]) if event.in_envelope else event.data[:8]
        name = " or ".join(map(type_name, found)) or f"unknown {mark.hex()}"
        if name not in self.types:
            self.types.append(name)
        try:
            decoded(event.data)
        except Exception:  # unknown type, or any error of generated code on broken bytes
            self.undecodable += 1
        else:
            head = header_of(event.data) if len(event.data) >= HEADER_SIZE else None
            if head:
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


def log_info(path: Path) -> LogInfo:
    """Reads a log from beginning to end and decodes every message.

    Raises:
        LogError: the file cannot be read or is not a log.
    """
    reader, info, channels = StampedLog(path), LogInfo(path), dict[str, ChannelInfo]()
    following = 0
    for event in reader:
        info.first_us = min(info.first_us, event.time_us) if info.events else event.time_us
        info.last_us = max(info.last_us, event.time_us) if info.events else event.time_us
        info.events += 1
        info.dropped += max(0, event.number - following) if not reader.skipped_bytes else 0
        following = event.number + 1
        channels.setdefault(event.channel, ChannelInfo()).add(event)
    info.size_bytes, info.damaged_bytes = path.stat().st_size, reader.skipped_bytes
    if info.damaged_bytes and not info.events:
        raise LogError(f"{path}: not an LCM log: no event in {info.damaged_bytes} bytes")
    info.channels = dict(sorted(channels.items()))
    return info

"""Sinks of the gateway: LCM log, public bus, display, and the newest messages for the summary."""

import json
import socket
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Protocol

from fwk.bus.public import PublicBus
from fwk.clock import US_PER_S, monotonic_us
from fwk.gateway.connections import Sink
from fwk.model.names import RESERVED
from fwk.model.plan import Plan
from fwk.model.plan_document import document_of
from fwk.model.sections import RecordPlan, choice_in_words
from fwk.model.selection import matches
from fwk.recording.indexed_log import IndexedLogWriter
from fwk.recording.part_compressor import PartCompressor
from fwk.recording.versions import EXCERPT, PLAN, excerpt
from lcmtypes.core import plan_t, protocol_t

_MB = 1_000_000
_GB = 1_000_000_000
DISPLAY_PERIOD_US = US_PER_S // 4


class Recorder:
    """Writes the LCM log with logical time as time stamps, so that equal runs give equal logs."""

    def __init__(self, plan: Plan, path: Path, report: Callable[[str], None]) -> None:
        self._writer = IndexedLogWriter(path, report)
        first = plan_t()
        first.version = protocol_t.VERSION
        first.json = json.dumps(document_of(plan))
        self._writer.append(PLAN, first.encode(), 0)
        if not plan.record.has_all_channels:
            self._writer.append(EXCERPT, excerpt(choice_in_words(plan.record)), 0)
        self._report = report
        self._due_us = 0
        self._limit_bytes = round(plan.record.size_gb * _GB)
        self._part_bytes = round(plan.record.split_mb * _MB)
        self._part_us = round(plan.record.split_s * US_PER_S)
        self._part_began_us = self._time_us = 0
        self._compressor = PartCompressor(report) if plan.record.compress else None
        self._after_end = 0
        self._is_full = False

    @property
    def dropped(self) -> int:
        """Number of messages that could not be written, for example because the disk was full."""
        return self._writer.dropped

    @property
    def cut_bytes(self) -> int:
        """Size of what another program has cut off the recording."""
        return self._writer.cut_bytes

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Adds a message, unless the recording has reached its limit."""
        if self._is_full:
            self._after_end += 1
        else:
            self._time_us = time_us
            self._writer.append(channel, data, time_us)

    def tick(self) -> None:
        """Flushes the file once a second, so that a killed run leaves a log; ends parts and the recording."""
        if self._limit_bytes and not self._is_full and self._writer.size_bytes >= self._limit_bytes:
            self._is_full = True
            self._report(f"{self._writer.path}: the recording ends: it has reached record.size_gb; the run goes on")
        elif self._is_part_full():
            self._part_began_us = self._time_us
            finished = self._writer.split()
            if finished and self._compressor:
                self._compressor.add(finished)
        if monotonic_us() >= self._due_us:
            self._due_us = monotonic_us() + US_PER_S
            self._writer.flush()

    def close(self) -> None:
        """Finishes the log."""
        self._writer.close()
        if self._compressor:
            self._compressor.add(self._writer.newest_part)
            self._compressor.close()
        if self._writer.dropped:
            self._report(f"{self._writer.path}: {self._writer.dropped} messages are missing in the recording")
        if self._after_end:
            self._report(f"{self._writer.path}: {self._after_end} messages came after the end of the recording")

    def _is_part_full(self) -> bool:
        if self._is_full:
            return False
        if self._part_bytes and self._writer.part_bytes >= self._part_bytes:
            return True
        return bool(self._part_us) and self._time_us - self._part_began_us >= self._part_us


class ChosenChannels:
    """Passes the messages of the channels on that the launch file wants recorded, and all of the framework's own."""

    def __init__(self, sink: Sink, record: RecordPlan) -> None:
        self._sink = sink
        self._record = record
        self._known: dict[str, bool] = {}
        self.tick = sink.tick
        self.close = sink.close

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Passes a message on, if its channel is recorded."""
        chosen = self._known.get(channel)
        if chosen is None:
            chosen = self._known[channel] = channel.startswith(RESERVED) or self._is_chosen(channel)
        if chosen:
            self._sink.message(channel, data, time_us)

    def _is_chosen(self, channel: str) -> bool:
        included = not self._record.channels or any(matches(channel, each) for each in self._record.channels)
        return included and not any(matches(channel, each) for each in self._record.exclude)


class Pace(Protocol):
    """Sends datagrams with pauses between them."""

    @property
    def unheard(self) -> bool:
        """Whether no program can listen."""

    def put(self, datagrams: Iterable[bytes]) -> None:
        """Adds the datagrams of a message."""

    def tick(self) -> None:
        """Notes that a tick is complete."""


class Mirror:
    """Publishes everything on the public bus, except what came from there, a few datagrams at a time."""

    def __init__(self, plan: Plan, bus: PublicBus, pace: Pace) -> None:
        self._bus = bus
        self._pace = pace
        self._came_from_there = frozenset(plan.outside)

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Publishes a message, if a program can listen."""
        if not self._pace.unheard and channel not in self._came_from_there:
            self._pace.put(self._bus.datagrams(channel, data))

    def tick(self) -> None:
        """Spreads the messages of the tick over the time until the next one."""
        self._pace.tick()

    def close(self) -> None:
        """Does nothing."""


class Display:
    """Feeds the display: lines and status at once, newest messages four times a second."""

    def __init__(self, plan: Plan, connection: socket.socket, report: Callable[[str], None]) -> None:
        self._connection = connection
        self._report = report
        self._has_ended = False
        self._shown = frozenset(plan.scoreboard_channels)
        self._newest: dict[str, bytes] = {}
        self._due_us = 0

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message."""
        if channel in ("fwk/log", "fwk/status"):
            self._send(channel, data)
        elif channel in self._shown:
            self._newest[channel] = data

    def tick(self) -> None:
        """Sends the changed messages when it is time."""
        if monotonic_us() >= self._due_us:
            self._due_us = monotonic_us() + DISPLAY_PERIOD_US
            for channel, data in self._newest.items():
                self._send(channel, data)
            self._newest = {}

    def close(self) -> None:
        """Sends the remaining messages; the display ends by itself."""
        self._due_us = 0
        self.tick()
        self._connection.close()

    def _send(self, channel: str, data: bytes) -> None:
        try:
            self._connection.send(channel.encode() + b"\0" + data, socket.MSG_DONTWAIT)
        except ConnectionError:
            if not self._has_ended:
                self._has_ended = True
                self._report("the display has ended; the run goes on without it")
        except OSError:  # a slow terminal: the display lacks a message, the run does not wait
            return


LOST = "fwk/lost"
"""Key of the data for the supervisor at the end: number of messages that the recording lacks."""


class Newest:
    """Keeps the newest message of each channel; passes them and the number of losses to the supervisor at the end."""

    def __init__(self, plan: Plan, connection: socket.socket, lost: Callable[[], int]) -> None:
        self._lost = lost
        self._wanted = frozenset(plan.scoreboard_channels)
        self._newest: dict[str, bytes] = {}
        self._connection = connection

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message."""
        if channel in self._wanted:
            self._newest[channel] = data

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Passes the messages to the supervisor."""
        self._connection.setblocking(True)
        for channel, data in {**self._newest, LOST: str(self._lost()).encode()}.items():
            try:
                self._connection.send(channel.encode() + b"\0" + data)
            except OSError:
                return

"""Reads recordings of system tests."""

from collections import defaultdict
from pathlib import Path
from typing import Any

from fwk.lcm import type_registry as types
from fwk.lcm.event_log import LogReader
from fwk.lcm.messages import Header
from fwk.model.tick_events import TickEvent, events_of
from fwk.recording.compare import Comparison
from lcmtypes.core import tick_record_t


class Recording:
    """The messages and tick records of a log."""

    def __init__(self, path: Path) -> None:
        self.messages: dict[str, list[bytes]] = defaultdict(list)
        """By channel, without the framework's own."""
        self.records: list[tick_record_t] = []
        self.events: list[tuple[int, TickEvent]] = []
        """Tick events with their tick, in their order."""
        for event in LogReader(path):
            if event.channel == "fwk/record":
                record = tick_record_t.decode(event.data)
                self.records.append(record)
                self.events += [(record.tick, each) for each in events_of(record.events)]
            elif not event.channel.startswith("fwk/"):
                self.messages[event.channel].append(event.data)

    def headers(self, channel: str) -> list[Header]:
        """Returns the headers of a channel's messages."""
        return [Header.of(data) for data in self.messages[channel]]

    def decoded(self, channel: str) -> list[Any]:
        """Returns the messages of a channel, decoded."""
        found: list[Any] = [types.types_of(data)[0].decode(data) for data in self.messages[channel]]
        return found

    def gaps(self) -> dict[str, list[int]]:
        """Returns the channels whose sequence numbers are not 1, 2, 3, ..."""
        numbers = {channel: [header.sequence for header in self.headers(channel)] for channel in self.messages}
        return {channel: found for channel, found in numbers.items() if found != list(range(1, len(found) + 1))}


def difference(a: Path, b: Path) -> str:
    """Returns the first difference of two logs; empty if they are equal."""
    found = Comparison(a, b).difference
    return str(found) if found else ""

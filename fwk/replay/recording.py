"""A recording as the main loop saw it: ticks with their events, and the messages that each made visible."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fwk.plan.model import Plan
from fwk.record.log import LogReader
from fwk.record.types import header_of
from lcmtypes.core import plan_t, tick_record_t

PLAN = "fwk/plan"
RECORD = "fwk/record"


class RecordingError(Exception):
    """A log that cannot be replayed; says which and why."""


@dataclass(frozen=True)
class RecordedTick:
    """One tick: what the main loop did, and the messages that became visible in it."""

    record: tick_record_t
    messages: dict[tuple[str, int, int], list[bytes]]
    """By channel and the (tick, stage) in which they were written, oldest first."""


class Recording:
    """A log with the plan of its run in it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader = LogReader(path)
        self.plan = self._plan()

    def ticks(self) -> Iterator[RecordedTick]:
        """All ticks, in order."""
        messages: dict[tuple[str, int, int], list[bytes]] = {}
        for event in self._reader:
            if event.channel == RECORD:
                yield RecordedTick(tick_record_t.decode(event.data), messages)
                messages = {}
            elif not event.channel.startswith("fwk/"):
                header = header_of(event.data)
                if header:
                    messages.setdefault((event.channel, header.tick, header.stage), []).append(event.data)

    def _plan(self) -> Plan:
        for event in self._reader:
            if event.channel == PLAN:
                return Plan.from_json(json.loads(plan_t.decode(event.data).json))
            if event.channel == RECORD:
                break
        raise RecordingError(
            f"{self.path}: no plan in it, so it cannot be replayed; logs that fwk-launch records have one, "
            "logs of lcm-logger do not"
        )

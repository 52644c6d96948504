"""A recording as the main loop saw it: ticks with their events, and the messages that each made visible."""

import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fwk.plan.model import NOBODY, Plan
from fwk.record.log import Event, LogReader
from fwk.record.types import header_of
from lcmtypes.core import plan_t, tick_event_t, tick_record_t

PLAN = "fwk/plan"
RECORD = "fwk/record"
_BROKEN = (ValueError, struct.error, LookupError, TypeError, AttributeError, RecursionError)
"""What reading plain data raises that is not what it should be."""


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
                yield RecordedTick(self._record(event), messages)
                messages = {}
            elif not event.channel.startswith("fwk/"):
                header = header_of(event.data)
                if header:
                    messages.setdefault((event.channel, header.tick, header.stage), []).append(event.data)

    def _record(self, event: Event) -> tick_record_t:
        try:
            record = tick_record_t.decode(event.data)
            for change in record.changes:
                json.loads(change.settings)
            sound = all(map(self._possible, record.events))
        except _BROKEN:
            sound = False
        if not sound:
            raise RecordingError(
                f"{self.path}: damaged: event {event.number}, a record of the main loop, cannot be read; "
                "replay what is before it with --to-tick"
            )
        return record

    def _possible(self, event: tick_event_t) -> bool:
        plan = self.plan
        if event.kind == tick_event_t.MAIN_LOOP and not NOBODY <= event.tick < len(plan.components):
            return False
        if event.kind == tick_event_t.DONE and event.stage < 0:
            return event.index == len(plan.hosts)  # the gateway: messages from outside
        return 0 <= event.index < len(plan.stages if event.kind == tick_event_t.STAGE else plan.hosts)

    def _plan(self) -> Plan:
        for event in self._reader:
            if event.channel == PLAN:
                try:
                    return Plan.from_json(json.loads(plan_t.decode(event.data).json))
                except _BROKEN as error:
                    raise RecordingError(
                        f"{self.path}: its plan cannot be read ({type(error).__name__}: {error}); the log is damaged, "
                        "or of another version"
                    ) from error
            if event.channel == RECORD:
                break
        raise RecordingError(
            f"{self.path}: no plan in it, so it cannot be replayed; logs that fwk-launch records have one, "
            "logs of lcm-logger do not"
        )

"""A recording as the main loop saw it: ticks with their events, and the messages that each made visible."""

import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from fwk.lcm.envelope import marked
from fwk.lcm.event_log import Event
from fwk.lcm.messages import fingerprint
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import header_of
from fwk.model.channel_table import facts_of
from fwk.model.names import LINES
from fwk.model.plan import NOBODY, Plan
from fwk.recording.pictures import FRAME, RecordedPicture, picture_of
from lcmtypes.core import change_t, plan_t, tick_event_t, tick_record_t

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
    frames: list[RecordedPicture]
    """Of the cameras whose frames are recorded."""


class Recording:
    """A log with the plan of its run in it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader = StampedLog(path)
        self.plan = self._plan()
        self._cameras = {channel.index for channel in self.plan.channels if channel.images}
        self._channels = {channel.index for channel in self.plan.channels}  # and those opened while the run went on

    @property
    def skipped_bytes(self) -> int:
        """How many bytes the newest reading passed over; only at the end of the log, where a run was cut off."""
        return self._reader.skipped_bytes

    def ticks(self, to_tick: int | None = None, types: Mapping[str, bytes] | None = None) -> Iterator[RecordedTick]:
        """All ticks, in order, until `to_tick` if one is given.

        Raises:
            RecordingError: the log is damaged before that, or lacks messages, or a message of a channel in `types`
                does not begin with that fingerprint.
        """
        messages: dict[tuple[str, int, int], list[bytes]] = {}
        frames: list[RecordedPicture] = []
        types = {RECORD: fingerprint(tick_record_t), **(types or {})}
        tick = 0
        for number, event in enumerate(self._reader):
            if event.number != number:
                raise RecordingError(self._gap(event.number - number, tick))
            if event.data[:8] != types.get(event.channel, event.data[:8]):
                raise RecordingError(self._other_type(event, types[event.channel]))
            if event.channel == RECORD:
                record = self._record(event)
                yield RecordedTick(record, messages, frames)
                tick, messages, frames = record.tick, {}, []
                if to_tick is not None and tick >= to_tick:
                    return
            elif event.channel == FRAME:
                frames += [picture] if (picture := picture_of(event.data)) else []
            elif event.channel == LINES or not event.channel.startswith("fwk/"):
                header = header_of(event.data)
                if header:
                    messages.setdefault((event.channel, header.tick, header.stage), []).append(event.data)
                elif event.channel in types:  # passed over, it would be taken for lost and never be compared
                    raise RecordingError(f"{self.path}: damaged: {event.channel} has a message without a whole header")

    def _gap(self, missing: int, tick: int) -> str:
        skipped = self.skipped_bytes
        cause = f"{skipped} bytes are damaged" if skipped else "the disk was full, or somebody took them out"
        before = f"; replay what is before it with --to-tick {tick}" if tick else ""
        return f"{self.path}: {missing} messages are missing after tick {tick}: {cause}{before}"

    def _other_type(self, event: Event, expected: bytes) -> str:
        if marked(event.data[:8]) == expected:
            return (
                f"{self.path}: {event.channel} has a message without the stamp that says what readers saw of it when; "
                "it was not in a run of ours, or somebody took the stamp out"
            )
        return (
            f"{self.path}: {event.channel} has a message that is no {self._type_of(event.channel)} as it is now; the "
            ".lcm file was changed since (the run directory keeps the one of the run), or the log is damaged"
        )

    def _type_of(self, name: str) -> str:
        types = {channel.name: channel.type_name for channel in self.plan.channels}
        return types.get(name, "core.tick_record_t")

    def _record(self, event: Event) -> tick_record_t:
        try:
            record = tick_record_t.decode(event.data)
            told = {change.number for change in record.changes if self._readable(change)}
            sound = self._channels.issuperset(record.channel)
            sound &= all(self._possible(event, told) for event in record.events)
        except _BROKEN:
            sound = False
        if not sound:
            raise RecordingError(
                f"{self.path}: damaged: event {event.number}, a record of the main loop, cannot be read; "
                "replay what is before it with --to-tick"
            )
        return record

    def _readable(self, change: change_t) -> bool:
        """Whether it is a change of the blackboard; what cannot be read raises."""
        if change.component != NOBODY:
            json.loads(change.settings)
            return False
        for fact in facts_of(change.settings):
            self.plan.components[fact.component].name  # noqa: B018 - it raises if there is none
            if fact.opening:
                self._channels.add(fact.opening.channel)
        return True

    def _possible(self, event: tick_event_t, told: set[int]) -> bool:
        plan = self.plan
        if event.kind == tick_event_t.OPENED:
            return event.tick in told
        if event.kind == tick_event_t.MAIN_LOOP and not NOBODY <= event.tick < len(plan.components):
            return False
        if event.kind == tick_event_t.FRAME_MISSED:
            return 0 <= event.index < len(plan.components) and event.stage in self._cameras
        if event.kind == tick_event_t.DONE and event.stage < 0:
            return event.index == len(plan.hosts)  # the gateway: messages from outside
        if event.kind == tick_event_t.MISSED and event.stage not in self._channels:
            return False
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

"""A recording as the main loop saw it: ticks with their events, and the messages that each made visible."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fwk.lcm.envelope import marked
from fwk.lcm.event_log import Event
from fwk.lcm.messages import fingerprint
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import header_of
from fwk.model.channel_table import Fact, facts_in
from fwk.model.names import LINES
from fwk.model.plain_values import value_of
from fwk.model.plan import NOBODY, Plan
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    FrameLost,
    HostLate,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    MessageLost,
    StageBegun,
    StageDone,
    TickEvent,
    events_of,
)
from fwk.recording.missing_parts import missing_parts
from fwk.recording.pictures import FRAME, RecordedPicture, picture_of
from fwk.recording.versions import (
    BROKEN,
    EXCERPT,
    PLAN,
    RECORD,
    message_of_today,
    read_plan,
    read_record,
    record_type,
)
from lcmtypes.core import excerpt_t, settings_change_t, tick_record_t

_OF_A_HOST = (StageDone, IterationDone, FinalDone, HostStarted, HostLost, HostLate, HostStopped, MessageLost)


class RecordingError(Exception):
    """A log cannot be replayed; names the log and the reason."""


@dataclass(frozen=True)
class RecordedTick:
    """A tick: its events, and the messages that became visible in it."""

    record: tick_record_t
    events: list[TickEvent]
    messages: dict[tuple[str, int, int], list[bytes]]
    """By channel and the (tick, stage) in which they were written, oldest first."""
    frames: list[RecordedPicture]
    """Frames of cameras whose frames are recorded."""


class Recording:
    """A log with the plan of its run in it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader = StampedLog(path)
        self.plan, self.version = self._plan()
        self._cameras = {channel.index for channel in self.plan.channels if channel.images}
        self._channels = {channel.index for channel in self.plan.channels}  # and those opened while the run went on

    @property
    def skipped_bytes(self) -> int:
        """Number of bytes that the last reading skipped: at the end of a log whose run was cut off."""
        return self._reader.skipped_bytes

    def ticks(self, types: Mapping[str, bytes] | None = None) -> Iterator[RecordedTick]:
        """Yields all ticks in order.

        Raises:
            RecordingError: the log is damaged there, or lacks messages, or a message of a channel in `types`
                does not begin with that fingerprint.
        """
        messages: dict[tuple[str, int, int], list[bytes]] = {}
        frames: list[RecordedPicture] = []
        types = {RECORD: fingerprint(record_type(self.version)), **(types or {})}
        tick = 0
        for number, event in enumerate(self._reader):
            if event.number != number:
                raise RecordingError(self._gap(event.number - number, tick))
            event = self._of_today(event)
            if event.channel == EXCERPT:
                text = excerpt_t.decode(event.data).text
                raise RecordingError(
                    f"{self.path}: cannot be replayed: it is a part of a recording ({text}); replay the whole"
                )
            if event.data[:8] != types.get(event.channel, event.data[:8]):
                raise RecordingError(self._other_type(event, types[event.channel]))
            if event.channel == RECORD:
                record, events = self._record(event)
                yield RecordedTick(record, events, messages, frames)
                tick, messages, frames = record.tick, {}, []
            elif event.channel == FRAME:
                frames += [picture] if (picture := picture_of(event.data)) else []
            elif event.channel == LINES or not event.channel.startswith("fwk/"):
                header = header_of(event.data)
                if header:
                    messages.setdefault((event.channel, header.tick, header.stage), []).append(event.data)
                elif event.channel in types:  # skipped, it would count as lost and never be compared
                    raise RecordingError(f"{self.path}: damaged: {event.channel} has a message without a whole header")

    def settings_at(self, tick: int) -> dict[int, Any]:
        """Returns the settings that components were given until the end of a tick, by component; reads tick records
        alone, up to a damaged one.
        """
        found: dict[int, Any] = {}
        with suppress(*BROKEN):
            for event in self._reader:
                if event.channel == RECORD:
                    record = read_record(event.data, self.plan, self.version)
                    if record.tick > tick:
                        break
                    found |= {change.component: value_of(change.values) for change in record.settings}
        return found

    def _of_today(self, event: Event) -> Event:
        try:
            data = message_of_today(event.data)
        except BROKEN as error:
            raise RecordingError(f"{self.path}: damaged: {event.channel} has a frame that cannot be read") from error
        return event if data is event.data else event._replace(data=data)

    def _gap(self, missing: int, tick: int) -> str:
        skipped = self.skipped_bytes
        cause = f"{skipped} bytes are damaged" if skipped else "the disk was full, or they were removed"
        if parts := missing_parts(self.path):
            cause = str(parts[0])
        before = f"; replay the ticks before it with --to-tick {tick}" if tick else ""
        return f"{self.path}: {missing} messages are missing after tick {tick}: {cause}{before}"

    def _other_type(self, event: Event, expected: bytes) -> str:
        if marked(event.data[:8]) == expected:
            return (
                f"{self.path}: {event.channel} has a message without the stamp that holds its header; "
                "fwk did not record it, or the stamp was removed"
            )
        return (
            f"{self.path}: {event.channel} has a message that is not a {self._type_of(event.channel)} as it is now; "
            "the .lcm file was changed since (the run directory keeps the one of the run), or the log is damaged"
        )

    def _type_of(self, name: str) -> str:
        types = {channel.name: channel.type_name for channel in self.plan.channels}
        return types.get(name, "core.tick_record_t")

    def _record(self, event: Event) -> tuple[tick_record_t, list[TickEvent]]:
        try:
            record = read_record(event.data, self.plan, self.version)
            for settings in record.settings:
                self._check_settings(settings)
            changed = {change.number for change in record.channels}
            for change in record.channels:
                self._open(facts_in(change))
            events = events_of(record.events)
            sound = self._channels.issuperset(record.channel)
            sound &= all(self._possible(event, changed) for event in events)
        except BROKEN:
            sound = False
        if not sound:
            raise RecordingError(
                f"{self.path}: damaged: event {event.number}, a record of the main loop, cannot be read; "
                "replay the ticks before it with --to-tick"
            )
        return record, events

    def _check_settings(self, change: settings_change_t) -> None:
        """Raises one of `BROKEN` if the settings of a component cannot be read."""
        if not 0 <= change.component < len(self.plan.components):
            raise ValueError(f"settings of component {change.component}")
        value_of(change.values)

    def _open(self, facts: list[Fact]) -> None:
        """Adds the channels of these facts; raises one of `BROKEN` for a component that the plan does not have."""
        for fact in facts:
            if not 0 <= fact.component < len(self.plan.components):
                raise ValueError(f"a channel of component {fact.component}")
            if fact.channel:
                self._channels.add(fact.channel.index)

    def _possible(self, event: TickEvent, changed: set[int]) -> bool:
        plan = self.plan
        if isinstance(event, ChannelsChanged):
            return event.change in changed
        if isinstance(event, MainLoopGiven):
            return NOBODY <= event.component < len(plan.components)
        if isinstance(event, FrameLost):
            return 0 <= event.component < len(plan.components) and event.channel in self._cameras
        if isinstance(event, StageBegun):
            return 0 <= event.stage < len(plan.stages)
        if isinstance(event, MessageLost) and event.channel not in self._channels:
            return False
        if isinstance(event, _OF_A_HOST):
            return 0 <= event.host < len(plan.hosts)
        return True

    def _plan(self) -> tuple[Plan, int]:
        for event in self._reader:
            if event.channel == PLAN:
                try:
                    return read_plan(event.data)
                except BROKEN as error:
                    raise RecordingError(
                        f"{self.path}: its plan cannot be read ({type(error).__name__}: {error}); the log is damaged, "
                        "or of another version"
                    ) from error
            if event.channel == RECORD:
                break
        self._reader.check_any()
        raise RecordingError(
            f"{self.path}: no plan in it, so it cannot be replayed; logs that fwk-launch records have one, "
            "logs of lcm-logger do not"
        )

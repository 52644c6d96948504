"""The recording of a history, read without the engine: messages and decisions of the main loop, as plain tuples."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fwk.lcm import envelope
from fwk.lcm.messages import Header, type_named
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import is_interface
from fwk.model import plain_values, tick_events
from lcmtypes.core import log_t, plan_t, tick_record_t

Event = tuple[str, int, int, int]
"""Kind of the event, and up to three numbers; see `_KINDS`."""

_KINDS: dict[type[Any], tuple[str, tuple[str, ...]]] = {
    tick_events.StageBegun: ("stage", ("stage", "step")),
    tick_events.StageDone: ("done", ("host", "tick", "step")),
    tick_events.IterationDone: ("done", ("host", "tick", "iteration")),
    tick_events.FinalDone: ("final", ("host", "tick")),
    tick_events.TickTold: ("told", ()),
    tick_events.OutsideTaken: ("outside", ()),
    tick_events.HostStarted: ("started", ("host", "incarnation")),
    tick_events.HostLost: ("lost", ("host",)),
    tick_events.HostLate: ("late", ("host",)),
    tick_events.HostStopped: ("stopped", ("host",)),
    tick_events.MainLoopGiven: ("main loop", ("component",)),
    tick_events.ChannelsChanged: ("channels", ()),
    tick_events.MessageLost: ("missed", ("host", "channel", "sequence")),
    tick_events.FrameLost: ("frame missed", ()),
}


@dataclass(frozen=True)
class Record:
    """The record of a tick."""

    tick: int
    events: list[Event]
    marks: dict[int, int]
    """Channel to the newest visible message at the end of the tick, where it changed."""
    settings: list[tuple[int, Any]]
    """Component and its settings, of each change that the tick began with."""


@dataclass
class Log:
    """A recording."""

    plan: dict[str, Any] = field(default_factory=dict)
    records: list[Record] = field(default_factory=list)
    messages: dict[str, list[tuple[Header, bytes]]] = field(default_factory=dict)
    """Messages by channel, in the order of the recording."""
    decoded: dict[str, list[Any]] = field(default_factory=dict)
    """The same, decoded, of the plan's channels."""
    lines: list[log_t] = field(default_factory=list)
    order: list[tuple[str, bytes]] = field(default_factory=list)
    """Channel and bytes of everything outside `fwk/`."""


def log_of(path: Path) -> Log:
    """Reads a recording."""
    made = Log()
    types: dict[str, Any] = {}
    for event in StampedLog(path):
        channel, data = event.channel, event.data
        if channel == "fwk/plan":
            made.plan = json.loads(plan_t.decode(data).json)
            types = {each["name"]: type_named(each["type_name"]) for each in made.plan["channels"]}
        elif channel == "fwk/record":
            made.records.append(record_of(tick_record_t.decode(data)))
        elif channel == "fwk/log":
            made.lines.append(log_t.decode(data))
        elif not channel.startswith("fwk/"):
            made.order.append((channel, data))
            if is_interface(data):
                made.messages.setdefault(channel, []).append((Header.of(data), data))
            if channel in types:
                made.decoded.setdefault(channel, []).append(envelope.decode(types[channel], data, channel))
    return made


def record_of(record: tick_record_t) -> Record:
    """Returns a record as plain data."""
    events: list[Event] = []
    for event in tick_events.events_of(record.events):
        kind, members = _KINDS[type(event)]
        numbers = [getattr(event, member) for member in members]
        events.append((kind, *[*numbers, 0, 0, 0][:3]))
    marks = dict(zip(record.channel, record.sequence, strict=True))
    settings = [(each.component, plain_values.value_of(each.values)) for each in record.settings]
    return Record(record.tick, events, marks, settings)

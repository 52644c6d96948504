"""Reads plans and tick records of recordings of this and earlier protocol versions."""

import json
import struct
from typing import Any

from fwk.lcm.messages import fingerprint
from fwk.model.channel_table import Fact, change_message, facts_of
from fwk.model.plain_values import value_messages
from fwk.model.plan import NOBODY, Plan
from fwk.model.plan_document import plan_from
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
    OutsideTaken,
    StageBegun,
    StageDone,
    TickEvent,
    TickTold,
    events_message,
)
from lcmtypes import core, core_v1
from lcmtypes.core import frame_t, protocol_t, settings_change_t, tick_record_t

PLAN = "fwk/plan"
"""Channel of the plan."""
RECORD = "fwk/record"
"""Channel of the tick records."""
EXCERPT = "fwk/excerpt"
"""Channel of the message that says that a log is a part of a recording."""
BROKEN = (ValueError, struct.error, LookupError, TypeError, AttributeError, RecursionError)
"""Exceptions of reading data that are damaged."""
_FRAME_WITHOUT_CAPTURE = fingerprint(core_v1.frame_t)
_EVENTS_OF_A_HOST: dict[int, type[HostLost | HostLate | HostStopped]] = {
    core_v1.tick_event_t.LOST: HostLost,
    core_v1.tick_event_t.LATE: HostLate,
    core_v1.tick_event_t.STOPPED: HostStopped,
}


def excerpt(text: str) -> bytes:
    """Returns the message that says which part of a recording a log is."""
    made = core.excerpt_t()
    made.text = text
    return bytes(made.encode())


def read_plan(data: bytes) -> tuple[Plan, int]:
    """Returns the plan of a recording and the protocol version of everything in the recording.

    Raises:
        ValueError, LookupError, TypeError, AttributeError, RecursionError, struct.error: the bytes are damaged, or of a
            version that this program does not know.
    """
    if data[:8] == fingerprint(core_v1.plan_t):
        return plan_from(json.loads(core_v1.plan_t.decode(data).json)), 1
    message = core.plan_t.decode(data)
    if message.version != protocol_t.VERSION:
        raise ValueError(
            f"protocol version {message.version}; this program reads versions 1 to {protocol_t.VERSION}, "
            "so a newer one wrote the recording"
        )
    return plan_from(json.loads(message.json)), message.version


def message_of_today(data: bytes) -> bytes:
    """Returns a message of a component as it is written today: announcements of frames had no capture time once.

    Raises:
        ValueError, struct.error, UnicodeDecodeError: the bytes are damaged.
    """
    if data[:8] != _FRAME_WITHOUT_CAPTURE:
        return data
    old, made = core_v1.frame_t.decode(data), frame_t()
    for name in core_v1.frame_t.__slots__:
        setattr(made, name, getattr(old, name))
    return bytes(made.encode())


def record_type(version: int) -> type[Any]:
    """Returns the type of tick records in recordings of a protocol version."""
    return core_v1.tick_record_t if version == 1 else tick_record_t


def read_record(data: bytes, plan: Plan, version: int) -> tick_record_t:
    """Returns a tick record as it is written today.

    Raises:
        ValueError, LookupError, TypeError, AttributeError, RecursionError, struct.error: the bytes are damaged.
    """
    return _upgraded(core_v1.tick_record_t.decode(data), plan) if version == 1 else tick_record_t.decode(data)


def _upgraded(old: core_v1.tick_record_t, plan: Plan) -> tick_record_t:
    made = tick_record_t()
    made.version, made.run, made.tick, made.time_us = protocol_t.VERSION, old.run, old.tick, old.time_us
    made.channel, made.sequence = old.channel, old.sequence
    made.voids = old.voids
    for change in old.changes:
        if change.component == NOBODY:
            facts: list[Fact] = facts_of(change.settings)
            made.channels.append(change_message(change.number, facts))
        else:
            settings = settings_change_t()
            settings.number, settings.component = change.number, change.component
            settings.values = value_messages(json.loads(change.settings))
            made.settings.append(settings)
    made.events = events_message([_event(each, plan) for each in old.events])
    return made


def _event(old: core_v1.tick_event_t, plan: Plan) -> TickEvent:
    kinds = core_v1.tick_event_t
    if old.kind == kinds.STAGE:
        return StageBegun(old.index, old.stage)
    if old.kind == kinds.DONE:
        return _done(old, plan)
    if old.kind == kinds.STARTED:
        return HostStarted(old.index, old.stage, old.tick)
    if old.kind in _EVENTS_OF_A_HOST:
        return _EVENTS_OF_A_HOST[old.kind](old.index)
    if old.kind == kinds.MAIN_LOOP:
        return MainLoopGiven(old.tick)
    if old.kind == kinds.TOLD:
        return TickTold()
    if old.kind == kinds.MISSED:
        return MessageLost(old.index, old.stage, old.tick)
    if old.kind == kinds.FRAME_MISSED:
        return FrameLost(old.index, old.stage, old.tick)
    if old.kind == kinds.OPENED:
        return ChannelsChanged(old.tick)
    raise ValueError(f"tick event of the unknown kind {old.kind}")


def _done(old: core_v1.tick_event_t, plan: Plan) -> TickEvent:
    if old.index == len(plan.hosts):
        return OutsideTaken()
    if old.stage == core_v1.done_stage_t.FINAL:
        return FinalDone(old.index, old.tick)
    first = plan.components[plan.hosts[old.index].components[0]]
    if first.rate_hz is not None:
        return IterationDone(old.index, old.tick, old.stage)
    return StageDone(old.index, old.tick, old.stage)

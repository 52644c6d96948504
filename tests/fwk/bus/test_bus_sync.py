"""The project's codec of ticks and dones writes and reads the same bytes as lcm-gen's code."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as some

from fwk.bus import sync
from fwk.lcm.messages import MessageError, to_dict
from fwk.model.channel_table import Fact, FactKind, OpenChannel, change_message, facts_in
from fwk.model.plain_values import value_messages, value_of
from fwk.model.requests import channel_request, lost_frame, lost_message, main_loop_request, plugin_request
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
    events_of,
)
from lcmtypes.core import done_t, settings_change_t, tick_record_t, tick_t, void_t

INT16, INT32, INT64 = (some.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (16, 32, 64))
TEXT = some.text('a{:}"é', max_size=20)
PLAIN = some.recursive(
    some.one_of(some.none(), some.booleans(), some.integers(), some.floats(allow_nan=False), TEXT),
    lambda inner: some.one_of(some.lists(inner, max_size=3), some.dictionaries(TEXT, inner, max_size=3)),
    max_leaves=8,
)
EVENTS: list[TickEvent] = [
    StageBegun(3, 4),
    StageDone(1, 2**40, 4),
    IterationDone(2, 8, 77),
    FinalDone(3, 9),
    TickTold(),
    OutsideTaken(),
    HostStarted(4, 2, 2**40),
    HostLost(5),
    HostLate(6),
    HostStopped(7),
    MainLoopGiven(-1),
    ChannelsChanged(2**33),
    MessageLost(1, 2, 2**34),
    FrameLost(1, 2, 2**35),
]


@some.composite
def facts(draw: some.DrawFn) -> Fact:
    """Draws any channel fact."""
    component, handle = draw(INT32), draw(INT32)
    kinds: list[FactKind] = ["read", "write", "close", "refuse", "come", "go"]
    kind = draw(some.sampled_from(kinds))
    if kind in ("come", "go"):
        return Fact(kind, component)
    if kind == "refuse":
        return Fact(kind, component, handle, reason=draw(TEXT))
    fingerprint = draw(some.binary(min_size=8, max_size=8).filter(any)).hex()
    opened = OpenChannel(component, handle, draw(INT32), draw(TEXT), draw(TEXT), fingerprint, draw(INT64))
    return Fact(kind, component, handle, opened)


@some.composite
def ticks(draw: some.DrawFn) -> tick_t:
    tick = tick_t()
    tick.version, tick.step = draw(INT16), draw(INT16)
    tick.run, tick.tick, tick.time_us = draw(INT64), draw(INT64), draw(INT64)
    tick.main_loop = draw(INT32)
    marks = draw(some.dictionaries(INT32, INT64, max_size=20))
    tick.n_marks, tick.channel, tick.sequence = len(marks), list(marks), list(marks.values())
    tick.absent = draw(some.lists(INT32, max_size=5))
    tick.n_absent = len(tick.absent)
    for _ in range(draw(some.integers(0, 3))):
        void = void_t()
        void.channel, void.above_sequence = draw(INT32), draw(INT64)
        void.up_to_tick, void.before_incarnation = draw(INT64), draw(INT32)
        tick.voids.append(void)
    tick.n_voids = len(tick.voids)
    for _ in range(draw(some.integers(0, 2))):
        change = settings_change_t()
        change.component, change.number = draw(INT32), draw(INT64)
        change.values = value_messages(draw(PLAIN))
        tick.settings.append(change)
    for number in range(draw(some.integers(0, 2))):
        tick.channels.append(change_message(number, draw(some.lists(facts(), max_size=3))))
    return tick


@some.composite
def dones(draw: some.DrawFn) -> done_t:
    done = done_t()
    done.run, done.host, done.incarnation, done.tick = draw(INT64), draw(INT32), draw(INT32), draw(INT64)
    done.kind, done.step, done.iteration = draw(some.integers(-128, 127)), draw(INT16), draw(INT16)
    done.next_time_us, done.busy_us = draw(INT64), draw(INT64)
    marks = draw(some.dictionaries(INT32, INT64, max_size=20))
    done.n_marks, done.channel, done.sequence = len(marks), list(marks), list(marks.values())
    if draw(some.booleans()):
        done.main_loop = [main_loop_request(draw(INT32), draw(some.lists(INT16, max_size=3)))]
        done.plugins = [plugin_request(draw(INT32), "reload", draw(some.lists(TEXT, max_size=3)))]
        fingerprint = draw(some.binary(min_size=8, max_size=8)).hex()
        asked: list[list[Any]] = [["close", draw(INT32)], ["each", draw(INT32), draw(TEXT), draw(TEXT), fingerprint]]
        done.channels = [channel_request(draw(INT32), each) for each in asked]
        done.lost = [lost_message(draw(INT32), draw(INT64))]
        done.lost_frames = [lost_frame(draw(INT32), draw(INT32), draw(INT64))]
    return done


@given(ticks())
def test_a_tick_has_the_bytes_of_lcm_gen(tick: tick_t) -> None:
    data = sync.encode_tick(tick)
    assert tick.encode() == data
    assert to_dict(sync.decode_tick(data)) == to_dict(tick_t.decode(data))


@given(dones())
def test_a_done_has_the_bytes_of_lcm_gen(done: done_t) -> None:
    data = sync.encode_done(done)
    assert done.encode() == data
    assert to_dict(sync.decode_done(data)) == to_dict(done_t.decode(data))


@given(some.lists(some.sampled_from(EVENTS), max_size=30), ticks())
def test_a_record_has_the_bytes_of_lcm_gen(events: list[TickEvent], tick: tick_t) -> None:
    record = tick_record_t()
    record.version, record.tick, record.channel, record.sequence = 2, tick.tick, tick.channel, tick.sequence
    record.voids, record.settings, record.channels = tick.voids, tick.settings, tick.channels
    record.events = events_message(events)
    data = sync.encode_record(record)
    assert data == record.encode()
    assert to_dict(sync.decode_record(data)) == to_dict(tick_record_t.decode(data))
    assert events_of(sync.decode_record(data).events) == events


@given(ticks(), some.integers(0, 200))
def test_a_truncated_tick_is_refused(tick: tick_t, cut: int) -> None:
    data = sync.encode_tick(tick)
    with pytest.raises(MessageError):
        sync.decode_tick(data[: max(0, len(data) - 1 - cut)])


@given(dones(), some.integers(0, 200))
def test_a_truncated_done_is_refused(done: done_t, cut: int) -> None:
    data = sync.encode_done(done)
    with pytest.raises(MessageError):
        sync.decode_done(data[: max(0, len(data) - 1 - cut)])


@given(some.binary(max_size=300))
def test_any_bytes_give_a_message_or_a_clear_error(data: bytes) -> None:
    kinds = ((sync.decode_tick, tick_t), (sync.decode_done, done_t), (sync.decode_record, tick_record_t))
    for decode, kind in kinds:
        for prefix in (b"", kind._get_packed_fingerprint()):
            try:
                decode(prefix + data)
            except MessageError:
                continue


@given(PLAIN)
def test_plain_values_come_back_as_they_were(value: object) -> None:
    assert repr(value_of(value_messages(value))) == repr(value)


@given(some.lists(facts(), max_size=5))
def test_channel_facts_come_back_as_they_were(listed: list[Fact]) -> None:
    assert facts_in(change_message(1, listed)) == listed

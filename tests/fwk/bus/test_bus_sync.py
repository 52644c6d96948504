"""Our own codec of ticks and dones makes and reads the very bytes of lcm-gen's."""

import pytest
from hypothesis import given
from hypothesis import strategies as some

from fwk.bus import sync
from fwk.lcm.messages import MessageError, to_dict
from lcmtypes.core import change_t, done_t, tick_event_t, tick_record_t, tick_t, void_t

INT16, INT32, INT64 = (some.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (16, 32, 64))


@some.composite
def ticks(draw: some.DrawFn) -> tick_t:
    tick = tick_t()
    tick.run, tick.tick, tick.stage, tick.time_us = draw(INT64), draw(INT64), draw(INT16), draw(INT64)
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
        change = change_t()
        change.component, change.number = draw(INT32), draw(INT64)
        change.settings = draw(some.text('a{:}"é', max_size=20))
        tick.changes.append(change)
    tick.n_changes = len(tick.changes)
    return tick


@some.composite
def dones(draw: some.DrawFn) -> done_t:
    done = done_t()
    done.run, done.host, done.incarnation, done.tick = draw(INT64), draw(INT32), draw(INT32), draw(INT64)
    done.stage, done.next_time_us, done.busy_us = draw(INT16), draw(INT64), draw(INT64)
    marks = draw(some.dictionaries(INT32, INT64, max_size=20))
    done.n_marks, done.channel, done.sequence = len(marks), list(marks), list(marks.values())
    done.wishes = draw(some.text('a{:}"é', max_size=20))
    return done


@given(ticks())
def test_a_tick_has_the_bytes_of_lcm_gen(tick: tick_t) -> None:
    data = tick.encode()
    assert sync.encode_tick(tick) == data
    assert to_dict(sync.decode_tick(data)) == to_dict(tick_t.decode(data))


@given(dones())
def test_a_done_has_the_bytes_of_lcm_gen(done: done_t) -> None:
    data = done.encode()
    assert sync.encode_done(done) == data
    assert to_dict(sync.decode_done(data)) == to_dict(done_t.decode(data))


@given(some.lists(some.tuples(some.integers(-128, 127), INT32, INT64, INT16), max_size=30), INT64, dones())
def test_a_record_has_the_bytes_of_lcm_gen(events: list[sync.Event], tick: int, marks: done_t) -> None:
    record = tick_record_t()
    record.tick, record.n_marks = tick, marks.n_marks
    record.channel, record.sequence = marks.channel, marks.sequence
    data = sync.encode_record(record, events)
    assert to_dict(sync.decode_record(data)) == to_dict(tick_record_t.decode(record.encode()))
    for kind, index, at, stage in events:
        event = tick_event_t()
        event.kind, event.index, event.tick, event.stage = kind, index, at, stage
        record.events.append(event)
    record.n_events = len(events)
    assert data == record.encode()


@given(ticks(), some.integers(0, 200))
def test_a_truncated_tick_is_refused(tick: tick_t, cut: int) -> None:
    data = tick.encode()
    with pytest.raises(MessageError):
        sync.decode_tick(data[: max(0, len(data) - 1 - cut)])


@given(dones(), some.integers(0, 200))
def test_a_truncated_done_is_refused(done: done_t, cut: int) -> None:
    data = done.encode()
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

"""Ticks, dones and tick records to bytes and back: the same bytes as lcm-gen's code makes, several times faster.

These messages are most of the framework's own traffic.
"""

import struct
from collections.abc import Sequence

from fwk import messages
from fwk.messages import MessageError
from lcmtypes.core import change_t, done_t, tick_record_t, tick_t, void_t

TICK = b"fwk/tick"
DONE = b"fwk/done"

_TICK_HEAD = struct.Struct(">8sqqhqi")
_DONE_HEAD = struct.Struct(">8sqiiqhqqi")
_VOID = struct.Struct(">iqi")
_CHANGE = struct.Struct(">iqi")  # component, number, length of the text with its zero byte
_COUNT = struct.Struct(">i")
_EVENT = struct.Struct(">biqh")
_EVENTS_AT = 32  # where a tick record's count of events stands

Event = tuple[int, int, int, int]
"""Kind, index, tick and stage, as in core.tick_event_t."""
_TICK_FINGERPRINT = messages.fingerprint(tick_t)
_DONE_FINGERPRINT = messages.fingerprint(done_t)


def encode_tick(tick: tick_t) -> bytes:
    """The bytes of a tick; counts are those of the lists."""
    marks, absent, voids = len(tick.channel), len(tick.absent), len(tick.voids)
    head = _TICK_HEAD.pack(_TICK_FINGERPRINT, tick.run, tick.tick, tick.stage, tick.time_us, marks)
    body = struct.pack(f">{marks}i{marks}qi{absent}ii", *tick.channel, *tick.sequence, absent, *tick.absent, voids)
    packed = [_VOID.pack(void.channel, void.above_sequence, void.before_incarnation) for void in tick.voids]
    return b"".join([head, body, *packed, _COUNT.pack(len(tick.changes)), *map(_packed_change, tick.changes)])


def _packed_change(change: change_t) -> bytes:
    text = change.settings.encode()
    return _CHANGE.pack(change.component, change.number, len(text) + 1) + text + b"\0"


def decode_tick(data: bytes) -> tick_t:
    """A tick from its bytes.

    Raises:
        MessageError: they are no tick, or end too early.
    """
    tick = tick_t()
    try:
        found, tick.run, tick.tick, tick.stage, tick.time_us, marks = _TICK_HEAD.unpack_from(data)
        if found != _TICK_FINGERPRINT or marks < 0:
            raise MessageError(f"{len(data)} bytes with fingerprint {found.hex()} are no core.tick_t")
        values = struct.unpack_from(f">{marks}i{marks}qi", data, _TICK_HEAD.size)
        offset = _TICK_HEAD.size + 12 * marks + 4
        tick.n_marks, tick.channel, tick.sequence = marks, list(values[:marks]), list(values[marks:-1])
        tick.n_absent = values[-1]
        tick.absent = list(struct.unpack_from(f">{tick.n_absent}i", data, offset))
        offset += 4 * tick.n_absent
        (tick.n_voids,) = _COUNT.unpack_from(data, offset)
        offset += 4
        for index in range(tick.n_voids):
            void = void_t()
            void.channel, void.above_sequence, void.before_incarnation = _VOID.unpack_from(data, offset + 16 * index)
            tick.voids.append(void)
        offset += 16 * tick.n_voids
        (tick.n_changes,) = _COUNT.unpack_from(data, offset)
        offset += 4
        for _ in range(tick.n_changes):
            change = change_t()
            change.component, change.number, size = _CHANGE.unpack_from(data, offset)
            offset += _CHANGE.size + size
            if size < 1 or len(data) < offset:
                raise struct.error
            change.settings = data[offset - size : offset - 1].decode("utf-8", "replace")
            tick.changes.append(change)
    except (struct.error, OverflowError, MemoryError) as error:
        raise MessageError(f"truncated core.tick_t of {len(data)} bytes") from error
    return tick


def encode_done(done: done_t) -> bytes:
    """The bytes of a done; its count is that of the lists."""
    marks = len(done.channel)
    return struct.pack(
        f">8sqiiqhqqi{marks}i{marks}q",
        _DONE_FINGERPRINT,
        done.run,
        done.host,
        done.incarnation,
        done.tick,
        done.stage,
        done.next_time_us,
        done.busy_us,
        marks,
        *done.channel,
        *done.sequence,
    )


def decode_done(data: bytes) -> done_t:
    """A done from its bytes.

    Raises:
        MessageError: they are no done, or end too early.
    """
    done = done_t()
    try:
        (
            found,
            done.run,
            done.host,
            done.incarnation,
            done.tick,
            done.stage,
            done.next_time_us,
            done.busy_us,
            done.n_marks,
        ) = _DONE_HEAD.unpack_from(data)
        if found != _DONE_FINGERPRINT or done.n_marks < 0:
            raise MessageError(f"{len(data)} bytes with fingerprint {found.hex()} are no core.done_t")
        values = struct.unpack_from(f">{done.n_marks}i{done.n_marks}q", data, _DONE_HEAD.size)
    except (struct.error, OverflowError, MemoryError) as error:
        raise MessageError(f"truncated core.done_t of {len(data)} bytes") from error
    done.channel, done.sequence = list(values[: done.n_marks]), list(values[done.n_marks :])
    return done


def encode_record(record: tick_record_t, events: Sequence[Event]) -> bytes:
    """The bytes of a tick record with these events; those in `record` have to be none."""
    data = record.encode()
    packed = [_EVENT.pack(*event) for event in events]
    return b"".join([data[:_EVENTS_AT], _COUNT.pack(len(events)), *packed, data[_EVENTS_AT + _COUNT.size :]])


def decode_record(data: bytes) -> tick_record_t:
    """A tick record without its events, which only replay wants to know.

    Raises:
        MessageError: the bytes are no tick record, or end too early.
    """
    try:
        (events,) = _COUNT.unpack_from(data, _EVENTS_AT)
        rest = data[_EVENTS_AT + _COUNT.size + events * _EVENT.size :]
        return tick_record_t.decode(data[:_EVENTS_AT] + _COUNT.pack(0) + rest)
    except (struct.error, ValueError, OverflowError) as error:
        raise MessageError(f"{len(data)} bytes that are no core.tick_record_t") from error

"""Encoders, decoders and channels of the framework's own most frequent messages."""

from fwk.lcm.messages import decoder, encoder
from lcmtypes.core import (
    actual_t,
    announcement_t,
    done_t,
    fetch_records_t,
    header_t,
    leaving_t,
    recorded_t,
    taken_t,
    tick_record_t,
    tick_t,
)

TICK = b"fwk/tick"
DONE = b"fwk/done"
TAKEN = b"fwk/taken"
LEAVING = b"fwk/leaving"
ACTUAL = b"fwk/actual"
RECORD = b"fwk/record"
RECORDED = b"fwk/recorded"
ANNOUNCE = b"fwk/announce"
FETCH_RECORDS = b"fwk/fetch_records"
DONE_START = DONE + b"\0"  # follows the number of a done's datagram

encode_tick = encoder(tick_t, "fwk/tick")
decode_tick = decoder(tick_t, "fwk/tick")
encode_done = encoder(done_t, "fwk/done")
decode_done = decoder(done_t, "fwk/done")
encode_actual = encoder(actual_t, "fwk/actual")
decode_actual = decoder(actual_t, "fwk/actual")
encode_record = encoder(tick_record_t, "fwk/record")
decode_record = decoder(tick_record_t, "fwk/record")
encode_recorded = encoder(recorded_t, "fwk/recorded")
decode_recorded = decoder(recorded_t, "fwk/recorded")
decode_taken = decoder(taken_t, "fwk/taken")
decode_leaving = decoder(leaving_t, "fwk/leaving")
decode_announcement = decoder(announcement_t, "fwk/announce")
decode_fetch_records = decoder(fetch_records_t, "fwk/fetch_records")


def place_of(done: done_t) -> int:
    """Returns the value of `stage` in the headers of the messages that a done covers."""
    if done.kind == done_t.FINAL:
        return header_t.FINAL
    return done.iteration if done.kind == done_t.ITERATION else done.step


def taken(done: done_t, taker: int) -> bytes:
    """Returns the encoded answer to a done: `taker` has taken it."""
    made = taken_t()
    made.run, made.taker, made.incarnation = done.run, taker, done.incarnation
    made.kind, made.tick, made.iteration = done.kind, done.tick, done.iteration
    return made.encode()

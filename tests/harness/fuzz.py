"""What the fuzz tests share: hostile values, and messages with a few bytes changed."""

import struct
from typing import Any

from hypothesis import strategies as some

from fwk.bus import sync
from fwk.lcm import messages
from fwk.lcm.type_registry import by_fingerprint
from lcmtypes.core import change_t, done_t, tick_event_t, tick_record_t, tick_t, void_t

HOSTILE_TEXT = [
    "",
    " ",
    "-",
    "--",
    "-1",
    "0",
    "1_0",
    "0x10",
    "1e400",
    "-1e400",
    "nan",
    ".inf",
    "9" * 5000,
    str(2**63),
    str(2**64),
    "٣",
    "\0",
    "\udcff",
    "\n",
    "=",
    "x=",
    "=x",
    "a/b.c=d",
    "*",
    "[",
    "[" * 1200,
    "(" * 1200,
    "a{99999999999}",
    "(?P<",
    "{" * 1200,
    "&a [*a]",
    "!!python/object/apply:os.getcwd []",
    "%YAML 9",
    "../..",
    "/",
    "/dev/null",
    "x" * 300,
    "x" * 5000,
    "%s",
    "{}",
]
"""Values that people type by mistake, or to hurt."""

COUNTS = some.one_of(some.sampled_from([0, 1, -1, 2**31 - 1, -(2**31), 2**16]), some.integers(-(2**31), 2**31 - 1))


def all_types() -> list[type[messages.Message]]:
    """Every generated type."""
    return [made for found in by_fingerprint().values() for made in found]


def sync_messages() -> dict[type[messages.Message], bytes]:
    """A tick, a done and a record with something in every list."""
    void, change, event = void_t(), change_t(), tick_event_t()
    change.settings = '{"gain": 1}'
    tick, done, record = tick_t(), done_t(), tick_record_t()
    tick.run, tick.tick, tick.stage = 5, 7, 3
    for each in (tick, done, record):
        each.channel, each.sequence = [1, 2], [3, 4]
    tick.absent = [1]
    tick.voids, tick.changes = [void], [change, change]
    record.voids, record.changes, record.events = [void], [change], [event, event]
    made: tuple[Any, ...] = (tick, done, record)
    return {type(each): messages.encode(each, "fwk") for each in made}


DECODERS = {tick_t: sync.decode_tick, done_t: sync.decode_done, tick_record_t: sync.decode_record}


@some.composite
def damaged(draw: some.DrawFn, data: bytes) -> bytes:
    """The bytes with a few of them overwritten, left out or added."""
    made = bytearray(data)
    for _ in range(draw(some.integers(1, 3))):
        at = draw(some.integers(0, max(0, len(made) - 1)))
        kind = draw(some.integers(0, 3))
        if kind == 0:
            made[at : at + 1] = bytes([draw(some.integers(0, 255))])
        elif kind == 1:
            made[at : at + 4] = struct.pack(">i", draw(COUNTS))
        elif kind == 2:
            del made[at : at + draw(some.integers(1, 40))]
        else:
            made[at:at] = draw(some.binary(max_size=20))
    return bytes(made)

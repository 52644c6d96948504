"""Shared parts of the fuzz tests: hostile values, and messages with a few changed bytes."""

import struct
from typing import Any

from hypothesis import strategies as some

from fwk.bus import sync
from fwk.lcm import messages
from fwk.lcm.type_registry import by_fingerprint
from fwk.model.channel_table import Fact, OpenChannel, change_message
from fwk.model.plain_values import value_messages
from fwk.model.requests import channel_request, lost_frame, lost_message, main_loop_request, plugin_request
from fwk.model.tick_events import HostLost, StageBegun, StageDone, TickTold, events_message
from lcmtypes.core import channels_change_t, done_t, settings_change_t, tick_record_t, tick_t, void_t

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
"""Values that people type by mistake or with bad intent."""

COUNTS = some.one_of(some.sampled_from([0, 1, -1, 2**31 - 1, -(2**31), 2**16]), some.integers(-(2**31), 2**31 - 1))


def all_types() -> list[type[messages.Message]]:
    """Returns every generated type."""
    return [made for found in by_fingerprint().values() for made in found]


def sync_messages() -> dict[type[messages.Message], bytes]:
    """Returns a tick, a done and a record with an element in every list."""
    void, settings = void_t(), settings_change_t()
    settings.values = value_messages({"gain": 1.0, "names": ["a", None, True]})
    opened = OpenChannel(0, 1, 2, "r/note", "robot.imu_t", "00" * 8)
    channels: channels_change_t = change_message(3, [Fact("come", 0), Fact("write", 0, 1, opened)])
    tick, done, record = tick_t(), done_t(), tick_record_t()
    tick.run, tick.tick, tick.step = 5, 7, 3
    for each in (tick, done, record):
        each.channel, each.sequence = [1, 2], [3, 4]
    tick.absent = [1]
    done.main_loop, done.plugins = [main_loop_request(1, [0, 0])], [plugin_request(1, "stop", ["r/*", "q"])]
    done.channels, done.lost = [channel_request(1, ["close", 1])], [lost_message(1, 2)]
    done.lost_frames = [lost_frame(1, 2, 3)]
    tick.voids, tick.settings, tick.channels = [void], [settings, settings], [channels]
    record.voids, record.settings, record.channels = [void], [settings], [channels]
    record.events = events_message([StageBegun(1, 1), StageDone(0, 7, 1), HostLost(1), TickTold()])
    made: tuple[Any, ...] = (tick, done, record)
    return {type(each): messages.encode(each, "fwk") for each in made}


DECODERS = {tick_t: sync.decode_tick, done_t: sync.decode_done, tick_record_t: sync.decode_record}


@some.composite
def damaged(draw: some.DrawFn, data: bytes) -> bytes:
    """Draws the bytes with a few of them overwritten, removed or added."""
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

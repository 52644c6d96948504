"""Ticks that the messages of a log name."""

from fwk.lcm.envelope import STAMP
from fwk.recording.ticks import tick_of
from lcmtypes.core import log_t, stamp_t, tick_record_t
from tests.fwk.recording.recording_made import entry, odometry


def test_messages_name_their_tick() -> None:
    line, stamp, record = log_t(), stamp_t(), tick_record_t()
    line.tick, stamp.header.tick, record.tick = 5, 6, 7
    assert tick_of(*entry("a/odometry", odometry(4, 1), 4)[:2]) == 4
    assert tick_of("fwk/log", line.encode()) == 5
    assert tick_of(STAMP, stamp.encode()) == 6
    assert tick_of("fwk/record", record.encode()) == 7
    assert tick_of("fwk/log", b"broken") is None
    assert tick_of("JOYSTICK", b"whatever") is None

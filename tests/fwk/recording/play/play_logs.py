"""Builds logs to be played: recordings with their tick records, and logs as lcm-logger makes them."""

from pathlib import Path

from fwk.lcm.event_log import LogWriter
from fwk.model.names import NOTE
from lcmtypes.core import log_t, plan_t, tick_record_t
from tests.fwk.recording.recording_made import PERIOD_US, entries, odometry, write
from tests.fwk.recording.recording_made import entry as made_entry

BEGAN_US = 1_700_000_000_000_000


def recording(path: Path, ticks: int = 10, notes: dict[int, str] | None = None) -> Path:
    """Returns a recording of a robot: in each tick its odometry and a record, in some a note."""
    with LogWriter(path, print) as log:
        log.append("fwk/plan", plan_t().encode(), 0)
        for tick in range(1, ticks + 1):
            log.append(*made_entry("cyan1/odometry", odometry(tick, 1), tick))
            if text := (notes or {}).get(tick):
                log.append("fwk/log", line("supervisor", text), tick * PERIOD_US)
            record = tick_record_t()
            record.tick = tick
            log.append("fwk/record", record.encode(), tick * PERIOD_US)
    return path


def heard(path: Path, ticks: int = 10) -> Path:
    """Returns a log with headers and without records, whose time stamps are times of receipt."""
    return write(path, [(channel, data, BEGAN_US + time_us) for channel, data, time_us in entries(ticks)])


def foreign(path: Path, messages: int = 10) -> Path:
    """Returns a log of messages of an unknown type, 20 ms apart."""
    return write(path, [("arm", bytes([number]) * 16, BEGAN_US + number * 20_000) for number in range(messages)])


def line(component: str, text: str) -> bytes:
    """Returns an encoded log line."""
    said = log_t()
    said.component, said.text = component, text
    said.file = NOTE if component == "supervisor" else "drive.py"
    return bytes(said.encode())

"""Builds short recordings with plan and tick records, and logs like those of lcm-logger."""

import json
from pathlib import Path

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogReader
from fwk.model.names import NOTE
from fwk.model.plan_document import document_of
from fwk.testing.plans import plan_of
from lcmtypes.core import histogram_t, log_t, plan_t, protocol_t, stamp_t, tick_record_t
from tests.fwk.recording.recording_made import PERIOD_US, Entry, entry, odometry, world_model, write

PLAIN = "arm/times"
"""Channel of a type without the header."""


def recording(path: Path, ticks: int = 10, noted: int = 4) -> Path:
    """Writes a recording of some ticks, with a bookmark and a stamped message in each tick."""
    plan = plan_t()
    plan.version, plan.json = protocol_t.VERSION, json.dumps(document_of(plan_of({})))
    made: list[Entry] = [("fwk/plan", plan.encode(), 0)]
    for tick in range(1, ticks + 1):
        made += tick_of_recording(tick)
        if tick == noted:
            line = log_t()
            line.tick, line.text, line.component, line.file = tick, "ball taken away", "supervisor", NOTE
            made.append(("fwk/log", line.encode(), tick * PERIOD_US))
        record = tick_record_t()
        record.tick = tick
        made.append(("fwk/record", record.encode(), tick * PERIOD_US))
    return write(path, made)


def tick_of_recording(tick: int) -> list[Entry]:
    """The messages of a tick: three channels, one of them with stamps."""
    stamp = stamp_t()
    stamp.channel = PLAIN
    stamp.header.tick = stamp.header.sequence = tick
    return [
        entry("cyan1/odometry", odometry(tick, 1), tick),
        entry("cyan1/world_model", world_model(tick, 1), tick),
        (STAMP, stamp.encode(), tick * PERIOD_US),
        (PLAIN, histogram_t().encode(), tick * PERIOD_US),
    ]


def heard(path: Path, ticks: int = 10, zero_us: int = 1_700_000_000_000_000) -> Path:
    """Writes a log like one of lcm-logger: wall time, no plan, no records."""
    return write(
        path, [(*entry("cyan2/odometry", odometry(t, 2), t)[:2], zero_us + t * PERIOD_US) for t in range(ticks)]
    )


def channels_of(log: Path) -> list[str]:
    """Returns the channels of all events, in their order."""
    return [event.channel for event in LogReader(log)]

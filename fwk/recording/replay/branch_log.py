"""Recording of a branch: the beginning of the recording that it comes from, then its own messages."""

from collections.abc import Callable, Container, Set
from dataclasses import replace
from pathlib import Path

from fwk.gateway.unwrap import Unwrap, plain_channels
from fwk.lcm.event_log import LogReader
from fwk.recording.pictures import FRAME, picture_of
from fwk.recording.replay.recording import Recording
from fwk.recording.sinks import Recorder
from fwk.recording.ticks import tick_of
from fwk.recording.versions import PLAN, RECORD


def last_tick(log: Path) -> int:
    """Returns the last tick that a recording has whole; 0: it has none."""
    records = (tick_of(event.channel, event.data) for event in LogReader(log) if event.channel == RECORD)
    return max((tick for tick in records if tick is not None), default=0)


def begun_log(
    path: Path,
    recording: Recording,
    to_tick: int,
    cameras_again: Container[str],
    in_envelopes: Set[str],
    report: Callable[[str], None],
) -> Unwrap:
    """Writes the beginning of a recording, unchanged, as that of another; returns the sink for the rest.

    Args:
        path: the log to write.
        recording: the recording, with the plan that the log gets.
        to_tick: the last tick that is copied.
        cameras_again: cameras whose recorded frames are left out, because they run again.
        in_envelopes: dynamic channels whose messages are in envelopes, at any time.
        report: takes problems of the disk.
    """
    kept = tuple(camera for camera in recording.plan.record.frames if camera not in cameras_again)
    plan = replace(recording.plan, record=replace(recording.plan.record, frames=kept))
    recorder = Recorder(plan, path, report)
    for event in LogReader(recording.path):
        again = event.channel == FRAME and (picture := picture_of(event.data)) and picture.camera in cameras_again
        if event.channel != PLAN and not again:
            recorder.message(event.channel, event.data, event.time_us)
        if event.channel == RECORD and tick_of(event.channel, event.data) == to_tick:
            break
    return Unwrap(recorder, plain_channels(plan), in_envelopes)

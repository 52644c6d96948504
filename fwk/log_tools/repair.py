"""Makes a whole log of a damaged one, and says what was lost."""

from dataclasses import dataclass, field
from pathlib import Path

from fwk.lcm.event_log import LogReader
from fwk.log_tools.cut import EVENTS_PER_CALL, Progress
from fwk.log_tools.new_file import new_log
from fwk.recording.log_contents import ChangedBytes
from fwk.recording.log_index import changed
from fwk.recording.ticks import tick_of
from fwk.recording.versions import RECORD


@dataclass
class Repaired:
    """Result of a repair."""

    log: Path
    out: Path
    events: int = 0
    """Events in the new log: every whole event of the damaged one, with its number."""
    lost_bytes: list[tuple[int, int]] = field(default_factory=list)
    """First and last position of each part of the damaged log that is not a whole event."""
    lost_events: int = 0
    """Events that are missing before the newest whole one, according to the numbers of the events."""
    last_tick: int | None = None
    """Newest tick that is complete; None: the log holds no tick record."""
    changed: list[ChangedBytes] = field(default_factory=list)
    """Parts of the damaged log that are not what was written, according to its index; their whole events are kept."""
    unfinished_events: int = 0
    """Events after the record of that tick: of a tick that has no record."""


def repair(log: Path, out: Path, replace: bool = False, progress: Progress = lambda _: None) -> Repaired:
    """Writes every whole event of a log to a new log.

    Events keep their numbers, so that a replay still notices what is missing.

    Raises:
        LogError: the log cannot be read, holds no whole event, or the new one cannot be written.
    """
    reader, done = LogReader(log), Repaired(log, out, changed=changed(log))
    end = skipped = following = 0
    with new_log(out, replace) as made:
        for event in reader:
            if reader.skipped_bytes > skipped:
                done.lost_bytes.append((end, end + reader.skipped_bytes - skipped - 1))
                skipped = reader.skipped_bytes
            end = reader.position
            done.lost_events += max(0, event.number - following)
            following = made.events = event.number
            made.append(event.channel, event.data, event.time_us)
            following += 1
            done.events += 1
            done.unfinished_events += 1
            if event.channel == RECORD and (tick := tick_of(event.channel, event.data)) is not None:
                done.last_tick, done.unfinished_events = tick, 0
            if not done.events % EVENTS_PER_CALL:
                progress(end)
        if reader.skipped_bytes > skipped:
            done.lost_bytes.append((end, end + reader.skipped_bytes - skipped - 1))
    return done

"""Takes a part of a log: an interval of ticks or times, channels, types."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fwk.clock import US_PER_S
from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import Event, LogError, LogReader
from fwk.lcm.stamped_log import stamp_in
from fwk.log_tools.new_file import new_log
from fwk.log_tools.selection import Selection
from fwk.recording.play.timeline import Moment, MomentError, Timeline
from fwk.recording.versions import EXCERPT, PLAN, excerpt

Progress = Callable[[int], None]
"""Takes the number of bytes read so far."""
EVENTS_PER_CALL = 1000


@dataclass
class Cut:
    """Result of a cut."""

    log: Path
    out: Path
    events: int = 0
    """Events in the new log."""
    left_out: int = 0
    """Events of the interval that were not selected."""
    damaged_bytes: int = 0
    """Bytes of the interval that hold no whole event."""
    replayable: bool = False
    """Whether `fwk replay` can run components on the new log: it is the beginning of a recording, with all channels."""


def cut(
    log: Path,
    out: Path,
    selection: Selection,
    begin: str = "",
    end: str = "",
    last_s: float | None = None,
    replace: bool = False,
    progress: Progress = lambda _: None,
) -> Cut:
    """Writes a part of a log to a new log.

    Args:
        log: the log.
        out: the new log; its folder is created.
        selection: channels and types.
        begin: first moment: a tick (`1200`), a time (`12.5s`) or the text of a bookmark; empty: the beginning.
        end: last moment; its tick is in the new log; empty: the end.
        last_s: begins so many seconds before the present end of the log, which may still grow.
        replace: replaces an existing file.
        progress: takes the number of bytes read so far.

    Raises:
        LogError: the log cannot be read, the new one cannot be written, or there is nothing to write.
    """
    first, last, is_recording = _interval(log, begin, end, last_s)
    reader, done = LogReader(log), Cut(log, out)
    done.replayable = is_recording and not first.position and selection.is_all
    with new_log(out, replace) as made:
        if is_recording:
            plan = next(iter(LogReader(log)))
            begin_us = first.time_us if first.position else plan.time_us
            if selection.takes(plan):
                made.append(plan.channel, plan.data, begin_us)
                if not done.replayable:
                    words = f"the last {last_s:g} s" if last_s is not None else begin and f"from {begin}"
                    text = ", ".join(filter(None, (log.name, words, end and f"to {end}", *selection.texts)))
                    made.append(EXCERPT, excerpt(text), begin_us)
        for stamp, event in paired(_between(reader, first.position, last, progress)):
            if is_recording and event.channel == PLAN:
                continue
            done.replayable &= event.channel != EXCERPT
            if not selection.takes(event):
                done.left_out += 1
                continue
            if stamp and selection.takes_stamps:
                made.append(stamp.channel, stamp.data, stamp.time_us)
            made.append(event.channel, event.data, event.time_us)
        selection.check(str(log))
        done.events, done.damaged_bytes = made.events, reader.skipped_bytes
    return done


def paired(events: Iterator[Event]) -> Iterator[tuple[Event | None, Event]]:
    """Yields each message with its stamp, or None if it has none; a stamp without a message is left out."""
    stamps: dict[str, Event] = {}
    for event in events:
        if event.channel == STAMP and (stamp := stamp_in(event.data)):
            stamps[stamp.channel] = event
            continue
        yield stamps.pop(event.channel, None), event


def _interval(log: Path, begin: str, end: str, last_s: float | None) -> tuple[Moment, int | None, bool]:
    """Returns the first moment, the position behind the last event, and whether the log is a recording."""
    timeline = Timeline(log)
    try:
        if last_s is not None:
            first = timeline.of_time(max(timeline.begin.time_us, timeline.end_us - round(last_s * US_PER_S)))
        else:
            first = timeline.find(begin) if begin else timeline.begin
        growing_end = timeline.of_time(timeline.end_us) if last_s is not None else None
        last = timeline.find(end) if end else growing_end
    except MomentError as error:
        raise LogError(str(error)) from error
    if last and last.position < first.position:
        raise LogError(f"{log}: '{end}' is before '{begin}'; exchange --from and --to")
    after = timeline.after(last.position) if last else None
    return first, after.position if after else None, timeline.is_recording


def _between(reader: LogReader, first: int, last: int | None, progress: Progress) -> Iterator[Event]:
    for number, event in enumerate(reader.events_from(first)):
        if last is not None and reader.position > last:
            return
        if not number % EVENTS_PER_CALL:
            progress(reader.position)
        yield event

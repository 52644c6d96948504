"""Puts several logs into one, in the order of time."""

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fwk.clock import US_PER_S
from fwk.lcm.event_log import Event, LogError, LogReader
from fwk.log_tools.cut import EVENTS_PER_CALL, Progress, paired
from fwk.log_tools.new_file import new_log
from fwk.model.names import RESERVED
from fwk.recording.versions import EXCERPT, PLAN, excerpt

_DAY_US = 24 * 3600 * US_PER_S


@dataclass
class Merged:
    """Result of a merge."""

    logs: list[Path]
    out: Path
    events: int = 0
    damaged_bytes: int = 0
    shared_channels: list[str] = field(default_factory=list)
    """Channels of the application that several logs contain."""


def merge(
    logs: Sequence[Path], out: Path, align: bool = False, replace: bool = False, progress: Progress = lambda _: None
) -> Merged:
    """Writes the events of several logs to a new log, in the order of their time stamps.

    Each log keeps its own order. The plan of the first recording among them stays; a merged log is not replayed.

    Args:
        logs: the logs, two or more.
        out: the new log; its folder is created.
        align: counts the time of each log from its beginning, for logs of different clocks.
        replace: replaces an existing file.
        progress: takes the number of bytes read so far.

    Raises:
        LogError: a log cannot be read, the new one cannot be written, or the clocks of the logs differ.
    """
    sources = [_Source(log, align) for log in logs]
    zeros = [source.zero_us for source in sources]
    if not align and max(zeros) - min(zeros) > _DAY_US:
        early, late = (logs[zeros.index(pick(zeros))] for pick in (min, max))
        raise LogError(
            f"{late}: begins {(max(zeros) - min(zeros)) / _DAY_US:.0f} days after {early}: their clocks differ, as "
            "those of a recording and of lcm-logger do; let both begin at 0 s with --align"
        )
    done, channels, has_plan = Merged(list(logs), out), dict[str, set[int]](), False
    with new_log(out, replace) as made:
        for number, (_, place, event) in enumerate(
            heapq.merge(*(source.timed(place) for place, source in enumerate(sources)))
        ):
            channels.setdefault(event.channel, set()).add(place)
            if event.channel == PLAN and has_plan:
                continue
            made.append(event.channel, event.data, event.time_us)
            if event.channel == PLAN:
                has_plan = True
                made.append(EXCERPT, excerpt(f"{', '.join(log.name for log in logs)} in one log"), event.time_us)
            if not number % EVENTS_PER_CALL:
                progress(sum(source.reader.position for source in sources))
        done.events = made.events
    done.damaged_bytes = sum(source.reader.skipped_bytes for source in sources)
    done.shared_channels = sorted(
        name for name, places in channels.items() if len(places) > 1 and not name.startswith(RESERVED)
    )
    return done


class _Source:
    """A log that is merged."""

    def __init__(self, log: Path, align: bool) -> None:
        self.reader = LogReader(log)
        first = next(iter(self.reader), None)
        if first is None:
            raise LogError(f"{log}: nothing to merge: no event in it")
        self.zero_us = 0 if first.channel == PLAN else first.time_us
        self._shift_us = self.zero_us if align else 0

    def timed(self, place: int) -> Iterator[tuple["_Moment", int, Event]]:
        """Yields the events with the latest time until each, which orders them among those of other logs."""
        latest = 0
        for number, pair in enumerate(paired(iter(self.reader))):
            time_us = pair[1].time_us - self._shift_us
            latest = max(latest, time_us) if number else time_us
            for event in filter(None, pair):
                yield (latest, place, number), place, event._replace(time_us=time_us)


_Moment = tuple[int, int, int]
"""Time in us, place of the log, number of the event: a total order."""

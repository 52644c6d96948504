"""Moments of a log: where its ticks begin, found by tick, by time or by the text of a bookmark."""

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fwk.clock import US_PER_S
from fwk.lcm.event_log import Event, LogError, LogReader
from fwk.lcm.type_registry import header_of
from fwk.recording.log_contents import note_in
from fwk.recording.ticks import tick_of
from fwk.recording.versions import PLAN, RECORD

WITHOUT_TICKS_US = 50_000
"""Logged time of one step in a log without ticks."""
_TAIL_BYTES = 1 << 20
_NOTES_SHOWN = 8
_TICK = re.compile(r"\d+")
_TIME = re.compile(r"(\d+(?:\.\d*)?|\.\d+) *s")
_FRAMEWORK = "fwk/"


@dataclass(frozen=True)
class Moment:
    """Place between two events of a log where a tick begins."""

    position: int
    """In bytes from the beginning of the log."""
    tick: int | None
    """None: the log names no tick until there."""
    time_us: int
    """Time stamp of the first event after it, in us."""


class MomentError(Exception):
    """A moment that the log does not have; the text names the log and the moments that it has."""


class Timeline:
    """Ticks of a log with their places, read no further than necessary.

    In a recording a tick begins after the record of the tick before. Elsewhere it begins with the first message whose
    header names it; without such headers a step of 50 ms stands for a tick.

    Raises:
        LogError: the log cannot be read, or holds no event.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        first = next(iter(LogReader(path)), None)
        self.is_recording = first is not None and first.channel == PLAN
        """Whether `fwk-launch` made the log: its time stamps are logical times, and records end its ticks."""
        self._reader = LogReader(path)
        self._unread = self._recorded_ticks() if self.is_recording else self._heard_ticks()
        self._moments: list[Moment] = []
        self._notes: list[tuple[str, Moment]] = []
        if not self._read_on():
            self._reader.check_any()
            raise LogError(f"{path}: nothing to play: no message in it")
        self.begin = self._moments[0]
        """The beginning of the log."""
        self.zero_us = 0 if self.is_recording else self.begin.time_us
        """Time stamp that counts as 0 s."""
        self.end_us = self._last_time_us()
        """Time stamp of the last event."""

    def events_from(self, moment: Moment) -> Iterator[tuple[Event, int]]:
        """Yields the events after a moment, each with the position of its end."""
        reader = LogReader(self.path)
        for event in reader.events_from(moment.position):
            yield event, reader.position

    def at(self, position: int) -> Moment:
        """Returns the newest moment at or before a position."""
        self._read_until(lambda newest: newest.position > position)
        return self._moments[max(0, bisect_right(self._moments, position, key=lambda each: each.position) - 1)]

    def after(self, position: int) -> Moment | None:
        """Returns the first moment after a position; None: the log ends before."""
        self._read_until(lambda newest: newest.position > position)
        place = bisect_right(self._moments, position, key=lambda each: each.position)
        return self._moments[place] if place < len(self._moments) else None

    def find(self, text: str) -> Moment:
        """Returns a moment by tick (`1200`), by time (`12.5s`) or by the text of a bookmark or a part of it.

        Raises:
            MomentError: there is no such moment in the log.
        """
        if _TICK.fullmatch(text):
            return self.of_tick(int(text))
        if found := _TIME.fullmatch(text):
            return self.of_time(self.zero_us + round(float(found[1]) * US_PER_S))
        return self._of_note(text)

    def of_tick(self, tick: int) -> Moment:
        """Returns the moment at which a tick, or the first one after it, begins.

        Raises:
            MomentError: the log ends before.
        """
        self._read_until(lambda newest: (newest.tick or 0) >= tick)
        last = self._moments[-1].tick
        if last is None:
            raise MomentError(f"{self.path}: no ticks in it; choose a moment by time, such as '2.5s'")
        if last < tick:
            raise MomentError(f"{self.path}: no tick {tick}; the last one is {last}")
        return self._moments[bisect_left(self._moments, tick, key=lambda each: each.tick or 0)]

    def of_time(self, time_us: int) -> Moment:
        """Returns the moment of the newest tick that begins at or before a time stamp; the first one before all ticks.

        Raises:
            MomentError: the log ends before.
        """
        if time_us > self.end_us:
            raise MomentError(f"{self.path}: no {self.seconds(time_us):g}s in it; it ends at {self.length_s:g}s")
        self._read_until(lambda newest: newest.time_us > time_us)
        return self._moments[max(0, bisect_right(self._moments, time_us, key=lambda each: each.time_us) - 1)]

    def seconds(self, time_us: int) -> float:
        """Returns a time stamp as a user gives it: logical time in recordings, else time since the first event."""
        return (time_us - self.zero_us) / US_PER_S

    @property
    def length_s(self) -> float:
        """Time of the last event in s."""
        return self.seconds(self.end_us)

    def _of_note(self, text: str) -> Moment:
        seen, is_read = 0, False
        while True:
            for note, moment in self._notes[seen:]:
                if text and text in note:
                    return moment
            seen = len(self._notes)
            if is_read:
                there = ", ".join(f"'{note}'" for note, _ in self._notes[:_NOTES_SHOWN]) or "none"
                raise MomentError(
                    f"{self.path}: no bookmark '{text}' ('fwk note' writes them); there are: {there}; "
                    "a tick is given as 1200, a time as 12.5s"
                )
            is_read = not self._read_on()  # reads notes of the last tick, too

    def _read_until(self, reached: Callable[[Moment], bool]) -> None:
        while not reached(self._moments[-1]) and self._read_on():
            pass

    def _read_on(self) -> bool:
        """Reads on to the beginning of the next tick; returns whether there is one."""
        moment = next(self._unread, None)
        if moment:
            self._moments.append(moment)
        return moment is not None

    def _recorded_ticks(self) -> Iterator[Moment]:
        begins: int | None = 1  # tick that begins with the next event
        position = 0
        for event in self._reader:
            if begins is not None and event.channel != PLAN:
                moment = Moment(position, begins, event.time_us)
                yield moment
                begins = None
            if event.channel == RECORD:
                tick = tick_of(event.channel, event.data)
                begins = None if tick is None else tick + 1
            elif note := note_in(event.channel, event.data):
                self._notes.append((note.text, moment))
            if event.channel != PLAN:  # the plan belongs to the first tick
                position = self._reader.position

    def _heard_ticks(self) -> Iterator[Moment]:
        moment: Moment | None = None
        position = 0
        for event in self._reader:
            tick = moment.tick if moment else None
            header = None if event.channel.startswith(_FRAMEWORK) else header_of(event.data)
            begins = moment is None or (tick is None and event.time_us >= moment.time_us + WITHOUT_TICKS_US)
            if header and header.tick > (tick or 0):
                begins, tick = True, header.tick
            if begins:
                moment = Moment(position, tick, event.time_us)
                yield moment
            if moment and (note := note_in(event.channel, event.data)):
                self._notes.append((note.text, moment))
            position = self._reader.position

    def _last_time_us(self) -> int:
        """Returns the time stamp of the last event, from the end of the file."""
        start = max(0, self._reader.size_bytes - _TAIL_BYTES)
        times = [event.time_us for event in LogReader(self.path).events_from(start)]
        if not times:  # one event fills the tail
            times = [event.time_us for event in LogReader(self.path)]
        return max(self.begin.time_us, times[-1])

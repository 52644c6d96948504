"""Plays a log: says which messages are due, with pause, steps, jumps, speed and loop. It neither waits nor sends."""

from collections.abc import Iterator

from fwk.clock import SPEED_MAX, SPEED_MIN, US_PER_S
from fwk.lcm.event_log import Event
from fwk.recording.play.timeline import Moment, Timeline
from fwk.recording.versions import PLAN

NEVER_US = 1 << 62
"""Wall time at which nothing is due."""
FASTEST = 0.0
"""Speed without pauses between the ticks."""


class Player:
    """Position in a log, which advances with wall time.

    Args:
        timeline: the log.
        now_us: wall time at the start.
        speed: logged seconds in a wall second; 0: as fast as possible.
        start: where playing begins; None: at the beginning of the log.
        end: where playing ends; None: at the end of the log.
        loop: whether playing begins again at its end.
        paused: whether playing waits for `resume` or `step`.
    """

    def __init__(
        self,
        timeline: Timeline,
        now_us: int,
        speed: float = 1.0,
        start: Moment | None = None,
        end: Moment | None = None,
        loop: bool = False,
        paused: bool = False,
    ) -> None:
        self.timeline = timeline
        self.speed = speed
        self.loop = loop
        self.paused = paused
        self.messages = 0
        """Number of messages that were given out."""
        self.rounds = 0
        """Number of times that the log was played to its end."""
        self._start = start or timeline.begin
        self._end = end.position if end else None
        self._events: Iterator[tuple[Event, int]] = iter(())
        self._next: tuple[Event, int] | None = None
        self.position = 0
        """End of the newest message given out, in bytes from the beginning of the log."""
        self._newest = 0  # where that message begins
        self.time_us = 0
        """Time stamp of that message."""
        self._begun_wall_us, self._begun_us = now_us, 0  # wall time and time stamp since which the speed has held
        self._go_to(self._start, now_us)

    @property
    def ended(self) -> bool:
        """Whether all messages were given out."""
        return self._next is None

    @property
    def tick(self) -> int | None:
        """The tick of the newest message given out, or of the moment gone to; None: the log names none."""
        return self.timeline.at(self._newest).tick

    def due_us(self) -> int:
        """Returns the wall time at which the next message is due; `NEVER_US`: paused or ended."""
        if self._next is None or self.paused:
            return NEVER_US
        if self.speed == FASTEST or self._next[0].channel == PLAN:
            return self._begun_wall_us
        elapsed_us = self._next[0].time_us - self._begun_us
        return self._begun_wall_us + round(elapsed_us / self.speed)

    def due(self, now_us: int) -> list[Event]:
        """Returns the messages that are due, in the order of the log: no more than those of one tick."""
        if self.due_us() > now_us:
            return []
        given = self._rest_of_tick(now_us)
        if self.ended and self.loop:
            self._go_to(self._start, now_us)
        return given

    def pause(self) -> None:
        """Stops between two messages until `resume`."""
        self.paused = True

    def resume(self, now_us: int) -> None:
        """Goes on from the present position."""
        self.paused = False
        self._begin(now_us)

    def step(self, now_us: int) -> list[Event]:
        """Pauses; returns the messages up to the end of the present tick."""
        self.paused = True
        return self._rest_of_tick(now_us, whole=True)

    def set_speed(self, speed: float, now_us: int) -> None:
        """Changes the speed within its limits, from now on; 0: as fast as possible."""
        self.speed = min(max(speed, SPEED_MIN), SPEED_MAX) if speed != FASTEST else FASTEST
        self._begin(now_us)

    def seek(self, moment: Moment, now_us: int) -> None:
        """Goes to a moment of the log."""
        self._go_to(moment, now_us)

    def seek_by(self, seconds: float, now_us: int) -> None:
        """Goes forward, or back, by a logged time, at most to the ends of the log."""
        wanted_us = self.time_us + round(seconds * US_PER_S)
        self._go_to(
            self.timeline.of_time(min(max(wanted_us, self.timeline.begin.time_us), self.timeline.end_us)), now_us
        )

    def _rest_of_tick(self, now_us: int, whole: bool = False) -> list[Event]:
        following = self.timeline.after(self.position)
        given = []
        while self._next and (not following or self._next[1] <= following.position):
            if not whole and self.due_us() > now_us:
                break
            self._newest = self.position
            event, self.position = self._next
            if event.channel != PLAN:
                self.time_us = event.time_us
            given.append(event)
            self._advance()
        self.messages += len(given)
        self.rounds += bool(given) and self.ended
        return given

    def _advance(self) -> None:
        self._next = next(self._events, None)
        if self._next and self._end is not None and self._next[1] > self._end:
            self._next = None

    def _go_to(self, moment: Moment, now_us: int) -> None:
        self._events = self.timeline.events_from(moment)
        self.position, self.time_us = moment.position, moment.time_us
        self._newest = moment.position
        self._advance()
        self._begin(now_us)

    def _begin(self, now_us: int) -> None:
        self._begun_wall_us, self._begun_us = now_us, self.time_us

"""The run clock: the logical time of each tick, from its one source, and the wall time at which it may begin."""

from fwk.clock import US_PER_S, Clock
from fwk.model.plan import Plan


class RunClock:
    """Logical time of the run.

    Simulated time comes from the time source if there is one; otherwise it advances by the period in each tick. It
    proceeds at `speed` logical seconds per wall second, or without waiting if that is 0, and it can be paused and
    stepped. In real time, logical time is the wall time since the first tick, and a tick begins every period.
    """

    def __init__(self, plan: Plan, speed: float) -> None:
        self.period_us = plan.period_us
        self.wall = plan.clock == "wall"
        self.clock = Clock(plan.period_us)
        """The newest tick and its logical time."""
        self._speed = speed
        self._next_us = -1
        self._origin_us = -1  # wall clock only: wall time of logical time 0
        self._anchor: tuple[int, int] | None = None  # wall and logical time at which the speed was last set
        self._paused = False
        self._steps = 0  # ticks that may still begin while paused

    @property
    def tick(self) -> int:
        """Number of the newest tick."""
        return self.clock.tick

    @property
    def time_us(self) -> int:
        """Logical time of the newest tick."""
        return self.clock.now_us

    @property
    def speed(self) -> float:
        """Logical seconds per wall second; 0: as fast as possible."""
        return self._speed

    @speed.setter
    def speed(self, value: float) -> None:
        self._speed = value
        self._anchor = None

    @property
    def stands(self) -> bool:
        """Whether no tick may begin."""
        return self._paused and not self._steps

    def pause(self) -> None:
        """Lets no further tick begin."""
        self._paused, self._steps = True, 0

    def resume(self) -> None:
        """Lets ticks begin again, at the previous speed."""
        self._paused, self._steps, self._anchor = False, 0, None

    def step(self, ticks: int) -> None:
        """Lets the given number of further ticks begin, then none."""
        self._paused, self._steps, self._anchor = True, ticks, None

    @property
    def loop_time_us(self) -> float:
        """Wall time that a tick may take at this speed; 0: no limit."""
        return self.period_us if self.wall else self.period_us / self._speed if self._speed > 0 else 0.0

    def source(self, next_us: int) -> None:
        """Takes the logical time of the next tick from the time source."""
        self._next_us = next_us

    def begin_us(self, now_us: int) -> int:
        """Wall time at which the next tick may begin, as seen at wall time `now_us`."""
        if not self.wall and self._speed <= 0:
            return now_us
        upcoming = self.clock.tick * self.period_us if self.wall else self._upcoming_us()
        if self._anchor is None:
            self._anchor = (now_us, upcoming)
        wall_us, logical_us = self._anchor
        begin = wall_us + (upcoming - logical_us if self.wall else round((upcoming - logical_us) / self._speed))
        if begin < now_us - US_PER_S // 2:  # too slow for this speed: lost time is not made up
            self._anchor = (now_us, upcoming)
            return now_us
        return begin

    def advance(self, now_us: int) -> int:
        """Begins the next tick at wall time `now_us`; returns its logical time."""
        clock = self.clock
        clock.tick += 1
        if self._steps:
            self._steps -= 1
        if self.wall:
            if self._origin_us < 0:
                self._origin_us = now_us - self.period_us
            clock.now_us = max(clock.now_us + 1, now_us - self._origin_us)
        else:
            clock.now_us = self._upcoming_us()
        self._next_us = -1
        return clock.now_us

    def _upcoming_us(self) -> int:
        return self._next_us if self._next_us > self.time_us else self.time_us + self.period_us

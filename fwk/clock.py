"""The only module that reads clocks and waits: logical time for components, wall time for the framework."""

import operator
import time

US_PER_S = 1_000_000
_SILENT_ITERATIONS = 20  # iterations of a time source without a time, before it is reported
_TIME_MAX_US = 10**18  # of logical time: 30,000 years, which leaves room to add periods
SECONDS_MAX = 1e9
"""The longest duration that can be requested, 30 years."""
SPEED_MIN, SPEED_MAX = 1e-6, 1e6
"""Limits of the speed of simulated time, in logical seconds per wall second."""


class Clock:
    """Logical time of the running iteration, which components use instead of the wall clock.

    `now_us` and `tick` do not change during an iteration. In a replay the recording is the only source of time.
    """

    def __init__(self, period_us: int = 50_000) -> None:
        self.now_us = 0
        self.tick = 0
        self.stage = ""
        self.period_us = period_us
        """Nominal time between ticks."""
        self.every = 1
        """Number of ticks from one iteration of the component to the next."""

    @property
    def now_s(self) -> float:
        """Logical time in seconds."""
        return self.now_us / US_PER_S

    @property
    def period_s(self) -> float:
        """Nominal time between ticks in seconds."""
        return self.period_us / US_PER_S

    @property
    def iteration_s(self) -> float:
        """Nominal time from one iteration of the component to the next in seconds: `every` ticks."""
        return self.period_us * self.every / US_PER_S

    def since_s(self, time_us: int) -> float:
        """Returns the logical time since `time_us`, in s."""
        return (self.now_us - time_us) / US_PER_S


class TimeSource:
    """Sets the logical time of the next tick; the time-source aspect, of one component of a system.

    A simulator sets `next_us` in every iteration; otherwise time advances by the clock's period.
    """

    def __init__(self) -> None:
        self._next_us = -1
        self._wrong = 0
        self._silent = 0

    @property
    def next_us(self) -> int:
        """Logical time of the next tick, if it was set in this iteration; otherwise -1."""
        return self._next_us

    @next_us.setter
    def next_us(self, value: int) -> None:
        try:
            said_us = operator.index(value)
        except TypeError:
            said_us = -1
        if not 0 <= said_us <= _TIME_MAX_US:
            raise ValueError(f"next_us is {value!r}; it should be whole microseconds, from 0 to {_TIME_MAX_US}")
        self._next_us = said_us

    def _mistake(self, now_us: int) -> str:
        """Returns the mistake in `next_us` after an iteration at `now_us`, to be logged; mostly empty.

        A time that is not after `now_us` is reported the 1st, 10th, 100th time; a time that is not set is reported
        after some iterations in a row.
        """
        if self._next_us > now_us:
            self._silent = 0
        elif self._next_us >= 0:
            self._wrong += 1
            if str(self._wrong).strip("0") == "1":
                so_often = f" ({self._wrong} times so far)" if self._wrong > 1 else ""
                said = f"next_us = {self._next_us} is not after this tick's time, {now_us} us"
                return f"time source: {said}; time advances by the period instead{so_often}"
        else:
            self._silent += 1
            if self._silent == _SILENT_ITERATIONS:
                return f"time source: next_us was not set in {self._silent} iterations; time advances by the period"
        return ""


def rate_word(rate_hz: float) -> str:
    """Returns the rate of a continuous component as it is shown in place of stages."""
    return f"{rate_hz:g} Hz" if rate_hz else "continuous"


def turns_word(every: int, offset: int) -> str:
    """Returns the ticks in which a component iterates, as shown behind its stages; empty if it iterates in each."""
    return f" (tick % {every} = {offset % every})" if every > 1 else ""


def speed_word(speed: float) -> str:
    """Returns a speed in the form in which it is typed; 0 is as fast as possible."""
    return f"{speed:g}" if speed else "max"


def monotonic_us() -> int:
    """Returns monotonic wall time in us, for measuring and waiting, never for outputs of components."""
    return time.monotonic_ns() // 1000


def wall_us() -> int:
    """Returns wall time in us since the epoch, for log lines."""
    return time.time_ns() // 1000


def sleep_s(duration_s: float) -> None:
    """Waits; for tools and the framework's own processes only."""
    time.sleep(max(0.0, duration_s))

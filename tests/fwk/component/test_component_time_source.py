"""A time source that sets a wrong time, or no time, is named in the log."""

from typing import Any

from fwk import Clock, Component, Config, TimeSource
from fwk.testing import Bench


class SunConfig(Config):
    """Increments of the time that the component sets."""

    step_us: int = 10_000
    """From the time of the tick; 0 or less: not after it."""
    silent: bool = False
    until_tick: int = 1000
    """Last tick in which the time is set."""


class Sun(Component):
    stage = "think"
    config: SunConfig
    clock: Clock
    time_source: TimeSource

    def loop(self) -> None:
        if not self.config.silent and self.clock.tick <= self.config.until_tick:
            self.time_source.next_us = max(0, self.clock.now_us + self.config.step_us)


def logged(ticks: int, **settings: Any) -> list[str]:
    bench = Bench(Sun, **settings)
    bench.iterate(ticks)
    return [line.text for line in bench.logged]


def test_time_that_advances_is_not_reported() -> None:
    assert logged(30) == []


def test_time_set_backwards_is_reported_repeatedly() -> None:
    lines = logged(12, step_us=-1)
    assert lines[0] == (
        "time source: next_us = 49999 is not after this tick's time, 50000 us; time advances by the period instead"
    )
    assert [line.partition("instead")[2] for line in lines] == ["", " (10 times so far)"]


def test_a_time_source_that_never_sets_time_is_reported_once() -> None:
    assert logged(50, silent=True) == ["time source: next_us was not set in 20 iterations; time advances by the period"]


def test_a_time_source_that_stops_setting_time_is_reported_once() -> None:
    assert logged(50, until_tick=5) == [
        "time source: next_us was not set in 20 iterations; time advances by the period"
    ]

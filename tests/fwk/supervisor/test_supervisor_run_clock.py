"""The run clock: logical time of ticks and their wall time."""

from fwk import Component, Writes
from fwk.supervisor.run_clock import RunClock
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


def pace(speed: float, clock: str = "simulated") -> RunClock:
    return RunClock(plan_of({"r/senses": Senses}, period_s=0.05, clock=clock), speed)


def test_without_a_source_time_advances_by_the_period() -> None:
    clock = pace(0)
    assert [clock.advance(0) for _ in range(3)] == [50_000, 100_000, 150_000]


def test_a_source_sets_the_time_of_the_next_tick_once() -> None:
    clock = pace(0)
    clock.advance(0)
    clock.source(70_000)
    assert clock.advance(0) == 70_000
    assert clock.advance(0) == 120_000


def test_time_never_goes_back() -> None:
    clock = pace(0)
    clock.advance(0)
    clock.source(10)
    assert clock.advance(0) == 100_000


def test_speed_two_begins_ticks_twice_as_often() -> None:
    clock, begins, now = pace(2.0), [], 1_000_000
    for _ in range(4):
        now = clock.begin_us(now)
        begins.append(now - 1_000_000)
        clock.advance(now)
    assert begins == [0, 25_000, 50_000, 75_000]


def test_maximum_speed_never_waits() -> None:
    clock = pace(0)
    assert clock.begin_us(123) == 123


def test_a_slow_run_does_not_catch_up_with_lost_time() -> None:
    clock = pace(1.0)
    clock.begin_us(0)
    clock.advance(0)
    assert clock.begin_us(5_000_000) == 5_000_000
    clock.advance(5_000_000)
    assert clock.begin_us(5_000_100) == 5_050_000


def test_wall_clock_time_is_taken_unchanged() -> None:
    clock = pace(1.0, "wall")
    clock.begin_us(1_000_000)
    assert clock.advance(1_000_000) == 50_000
    assert clock.begin_us(1_000_500) == 1_050_000
    assert clock.advance(1_063_000) == 113_000


def test_paused_run_begins_no_tick_and_skips_no_time_later() -> None:
    clock = pace(1.0)
    clock.begin_us(0)
    clock.advance(0)
    clock.pause()
    assert clock.stands
    clock.resume()
    assert not clock.stands
    assert clock.begin_us(300_000) == 300_000
    clock.advance(300_000)
    assert clock.begin_us(300_000) == 350_000
    assert clock.time_us == 100_000


def test_steps_are_counted() -> None:
    clock = pace(1.0)
    clock.step(2)
    assert not clock.stands
    clock.advance(0)
    assert not clock.stands
    clock.advance(50_000)
    assert clock.stands
    clock.step(5)
    clock.pause()
    assert clock.stands

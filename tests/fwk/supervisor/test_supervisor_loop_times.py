"""Warnings about slow ticks and components."""

from typing import Any

from fwk import Component, Writes
from fwk.clock import Clock
from fwk.component.log import Logger
from fwk.supervisor.host_process import host_processes
from fwk.supervisor.loop_times import LoopTimes
from fwk.testing.plans import plan_of
from lcmtypes.core import component_state_t, log_t
from lcmtypes.robot import imu_t

MS, S = 1_000, 1_000_000
SENSE, THINK = 1, 5
SENSES, THINKS, DREAMS = 0, 1, 2


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Thinks(Component):
    stage = "think"
    thought: Writes[imu_t]


class Dreams(Component):
    stage = "think"
    dream: Writes[imu_t]


class Timed:
    """Ticks with durations that the test chooses."""

    def __init__(self, groups: list[list[str]] | None = None, **fields: Any) -> None:
        parts = {"r/senses": Senses, "r/thinks": Thinks, "r/dreams": Dreams}
        plan = plan_of(parts, groups=groups, **fields)
        self.table = host_processes(plan)
        self.logged: list[log_t] = []
        self.times = LoopTimes(plan, self.table, Logger("supervisor", Clock(), self.logged.append))

    def tick(self, at_us: int, sense_us: int = 2 * MS, think_us: int = 3 * MS, desired_us: float = 10 * MS) -> None:
        self.times.tick_begins(at_us)
        self.times.answered(SENSES, SENSE, sense_us, 7)
        self.times.stage_ended(SENSE, sense_us + 100)
        self.times.answered(THINKS, THINK, think_us, 7)
        self.times.stage_ended(THINK, think_us + 100)
        self.times.tick_ended(7, at_us + sense_us + think_us + 200, desired_us)

    @property
    def texts(self) -> list[str]:
        return [line.text for line in self.logged]


def test_histograms_of_stages_and_ticks() -> None:
    timed = Timed()
    for number in range(3):
        timed.tick(10 * S + number * 50 * MS)
    assert [histogram.count for histogram in timed.times.stages] == [0, 3, 0, 0, 0, 3, 0, 0, 0, 0]
    assert (timed.times.loop.count, timed.times.loop.worst_us) == (3, 5200)
    assert (timed.times.cycle.count, timed.times.cycle.worst_us) == (2, 50 * MS)
    assert timed.texts == []


def test_slow_tick_names_its_slowest_stage_and_component() -> None:
    timed = Timed()
    timed.tick(10 * S, think_us=30 * MS)
    assert timed.texts == [
        "loop time missed: tick 7 took 32.2 ms, desired are 10 ms; slowest stage think (30.1 ms), "
        "slowest component r/thinks (30.0 ms)"
    ]


def test_a_tick_is_judged_by_itself() -> None:
    timed = Timed()
    timed.tick(10 * S, think_us=30 * MS)
    timed.tick(30 * S, sense_us=20 * MS)
    assert "slowest stage sensor_acquire (20.1 ms), slowest component r/senses (20.0 ms)" in timed.texts[1]


def test_warnings_are_rare_and_count_what_they_left_out() -> None:
    timed = Timed()
    for number in range(100):
        timed.tick(10 * S + number * 200 * MS, think_us=30 * MS)
    assert len(timed.texts) == 2
    assert timed.texts[1].endswith("(49 more since the last such line)")


def test_slight_excess_or_no_desired_rate_gives_no_warning() -> None:
    timed = Timed()
    timed.tick(10 * S, think_us=8 * MS)  # 10.2 ms
    timed.tick(20 * S, think_us=800 * MS, desired_us=0)
    assert timed.texts == []


def test_warnings_can_be_turned_off() -> None:
    timed = Timed(loop_time_warnings=False, stage_time_us=1)
    timed.tick(10 * S, think_us=30 * MS)
    assert timed.texts == []


def test_lockstep_overruns_are_named_ten_times_then_rarely() -> None:
    timed = Timed(stage_time_us=4 * MS)
    for number in range(100):
        timed.tick(10 * S + number * 20 * MS, think_us=5 * MS)
    assert (
        timed.texts
        == [
            "r/thinks overran its stage: think of tick 7 took it 5.0 ms, allowed are 4 ms",
        ]
        * 10
    )
    timed.tick(100 * S, think_us=5 * MS)
    assert timed.texts[-1].endswith("allowed are 4 ms (90 more since the last such line)")


def test_in_real_time_the_loop_names_late_components() -> None:
    timed = Timed(stage_time_us=4 * MS, clock="wall")
    timed.tick(10 * S, think_us=5 * MS)
    assert timed.texts == []


def test_slowest_component_of_a_shared_process_is_named() -> None:
    timed = Timed(groups=[["r/senses"], ["r/thinks", "r/dreams"]])
    for name, busy_us in (("r/thinks", 10), ("r/dreams", 20)):
        told = component_state_t()
        told.name, told.iterations, told.busy_us = name, 1, busy_us
        timed.table[THINKS].components.append(told)
    timed.tick(10 * S, think_us=30 * MS)
    assert "slowest component r/dreams in process r/thinks+r/dreams (30.0 ms)" in timed.texts[0]

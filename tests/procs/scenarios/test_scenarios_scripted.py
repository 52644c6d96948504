"""Robots that drive and kick by a script."""

from typing import Any

import pytest

from fwk.testing import MemorySystem
from procs.model.events import Kind
from procs.scenarios.file import parsed
from procs.scenarios.scenario import system_of
from procs.scenarios.scripted import ScriptConfig
from tests.procs.scenarios.test_scenarios_crew import ask, logged, match, robot


def system_with(steps: str, more: str = "") -> MemorySystem:
    """Returns the system of a scenario with one scripted robot at (2, 3) that looks ahead along x."""
    text = f"scripted: {{cyan2: {steps}}}\nplaces: {{cyan2: [2.0, 3.0, 0.0]}}\nat_end: [ball_speed < 9]\ntime_s: 9\n"
    return system_of(parsed(text + more, "mine.yaml"))


def kicks(system: MemorySystem, ticks: int) -> list[tuple[float, float]]:
    """Returns time and speed of each kick in so many ticks."""
    found = []
    for _ in range(ticks):
        system.tick()
        report: Any = system.newest("world/match_events")
        found += [(system.now_us / 1e6, each.speed_m_s) for each in report.events if each.kind == Kind.KICK]
    return found


def test_robot_drives_from_step_to_step() -> None:
    system = system_with("[{at_s: 0.5, vx_m_s: 1.0}, {at_s: 1.5, vy_m_s: 0.5}, {at_s: 2.5}]")
    system.tick(10)
    assert robot(system, "cyan2").x_m == pytest.approx(2.0)
    system.tick(18)
    assert robot(system, "cyan2").vx_m_s == pytest.approx(1.0, abs=0.05)
    system.tick(20)
    assert robot(system, "cyan2").vy_m_s == pytest.approx(0.5, abs=0.05)
    assert robot(system, "cyan2").vx_m_s == pytest.approx(0.0, abs=0.05)
    system.tick(20)
    assert robot(system, "cyan2").vy_m_s == pytest.approx(0.0, abs=0.01)


def test_robot_without_steps_stands() -> None:
    system = system_with("[]")
    system.tick(20)
    assert robot(system, "cyan2").x_m == pytest.approx(2.0)


def test_steps_of_the_same_tick_follow_each_other() -> None:
    system = system_with("[{at_s: 0.501, vx_m_s: 1.0, kick_m_s: 3.0}, {at_s: 0.502, vy_m_s: 0.5}, {at_s: 0.503}]")
    said = []
    for _ in range(30):
        system.tick()
        command: Any = system.newest("cyan2/motor_command")
        said.append((command.vx_m_s, command.vy_m_s))
    begun = said.index((1.0, 0.0))
    assert said[begun : begun + 4] == [(1.0, 0.0), (0.0, 0.5), (0.0, 0.0), (0.0, 0.0)]


def test_step_kicks_once_when_the_robot_has_the_ball() -> None:
    system = system_with(
        "[{at_s: 0.3, vx_m_s: 0.8, dribble: true, kick_m_s: 3.0}, {at_s: 1.5, vx_m_s: 3.0}]",
        "ball: {x_m: 2.6, y_m: 3.0}\n",
    )
    ((time_s, speed_m_s),) = kicks(system, 70)
    assert 0.5 < time_s < 1.5
    assert speed_m_s == pytest.approx(3.8, abs=0.4)  # that of the kick and that of the robot


def test_each_step_kicks_anew() -> None:
    steps = "[{at_s: 0.3, dribble: true, vx_m_s: 0.5, kick_m_s: 0.5}, {at_s: 1.5, vx_m_s: 2.0, kick_m_s: 5.0}]"
    soft, hard = kicks(system_with(steps, "ball: {x_m: 2.5, y_m: 3.0}\n"), 120)
    assert soft[1] < 2.0 < 5.0 < hard[1]


def test_steps_out_of_order_are_refused_in_a_launch_file_too() -> None:
    with pytest.raises(ValueError, match=r"step 1 begins at 1 s; it should begin after 1 s"):
        ScriptConfig.model_validate({"steps": [{"at_s": 1.0}, {"at_s": 1.0}]})


def test_scripted_robots_are_held_in_a_match() -> None:
    system = match()
    ask(system, text="scripted: {cyan2: [{vx_m_s: 1.0}]}\nplaces: {cyan2: [2, 3, 0]}\nat_end: [ball_speed < 9]\n")
    system.tick(50)
    assert (robot(system, "cyan2").x_m, robot(system, "cyan2").y_m) == pytest.approx((2.0, 3.0), abs=0.01)
    assert logged(system)[-1] == "a match has no scripted robots; they are held: cyan2"

"""Navigator, skiller and agent on the bench."""

import math
from typing import Any

import pytest

from fwk import Component
from fwk.testing import Bench
from lcmtypes.soccer import (
    ball_estimate_t,
    drive_target_t,
    game_state_t,
    navigator_state_t,
    robot_estimate_t,
    skill_status_t,
)
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.referee.referee import Referee


def estimate(x_m: float, y_m: float) -> robot_estimate_t:
    made = robot_estimate_t()
    made.x_m, made.y_m = x_m, y_m
    return made


def seen_ball(x_m: float, y_m: float) -> ball_estimate_t:
    made = ball_estimate_t()
    made.known, made.x_m, made.y_m = True, x_m, y_m
    return made


def newest(bench: Bench, port: str) -> Any:
    return bench.port(port).sent[-1]


def put(bench: Bench, port: str, **fields: Any) -> None:
    """Puts a message of this tick; the bench itself leaves the time at zero."""
    made: Any = bench.port(port).message_type()
    made.header.time_us = bench.time_us
    bench.port(port).put(made, **fields)


def navigate(ticks: int = 1, localized: bool = True, **target: Any) -> Bench:
    bench = Bench(Navigator, "cyan2/navigator")
    for _ in range(ticks):
        put(bench, "world_model", localized=localized, heading_rad=math.pi / 2)
        put(bench, "odometry")
        put(bench, "drive_target", target_id=7, **target)
        bench.iterate()
    return bench


def test_navigator_drives_in_its_frame_within_its_acceleration() -> None:
    bench = navigate(3, x_m=5.0, heading_rad=math.pi / 2)
    commands = bench.port("motor_command").sent
    assert all(command.enabled for command in commands)
    speeds_m_s = [-command.vy_m_s for command in commands]  # east is to the right of a robot that faces north
    assert speeds_m_s == pytest.approx([0.15, 0.3, 0.45])
    state = newest(bench, "navigator_state")
    assert (state.target_id, state.arrived, state.error) == (7, False, navigator_state_t.OK)
    assert state.distance_m == pytest.approx(5.0)


def test_navigator_turns_the_short_way() -> None:
    assert newest(navigate(3, heading_rad=math.pi), "motor_command").omega_rad_s > 0
    assert newest(navigate(3, heading_rad=-math.pi * 0.4), "motor_command").omega_rad_s < 0


def test_navigator_reports_its_arrival() -> None:
    assert newest(navigate(x_m=0.02, heading_rad=math.pi / 2), "navigator_state").arrived


def test_navigator_keeps_the_speed_limit_of_the_target() -> None:
    command = newest(navigate(60, x_m=8.0, heading_rad=math.pi / 2, speed_m_s=0.8), "motor_command")
    assert math.hypot(command.vx_m_s, command.vy_m_s) == pytest.approx(0.8)


def test_robot_that_is_lost_stands_still_and_says_so() -> None:
    bench = navigate(5, localized=False, x_m=5.0)
    command = newest(bench, "motor_command")
    assert (command.vx_m_s, command.vy_m_s, command.omega_rad_s) == (0.0, 0.0, 0.0)
    assert newest(bench, "navigator_state").error == navigator_state_t.LOST


def test_old_target_is_braked_to_a_standstill() -> None:
    bench = navigate(10, x_m=5.0, heading_rad=math.pi / 2)
    fast = newest(bench, "motor_command").vy_m_s
    for _ in range(30):
        put(bench, "world_model", localized=True, heading_rad=math.pi / 2)
        bench.iterate()
    assert abs(fast) > 1.0
    assert newest(bench, "motor_command").vy_m_s == 0.0


def test_opponent_in_the_way_is_driven_around() -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    for avoid in (True, False):
        for _ in range(20):
            put(bench, "world_model", localized=True, opponents=[estimate(2.0, 0.05)])
            put(bench, "drive_target", x_m=4.0, avoid_robots=avoid)
            bench.iterate()
        command = newest(bench, "motor_command")
        assert (command.vy_m_s < -0.3) == avoid


def put_situation(bench: Bench, **fields: Any) -> None:
    bench.port("world_model").put(localized=True, **fields)
    bench.port("game_state").put(state=game_state_t.PLAY)


@pytest.mark.parametrize(("robot", "sign"), [("cyan2", 1.0), ("magenta2", -1.0)])
def test_both_teams_decide_alike(robot: str, sign: float) -> None:
    bench = Bench(Agent, f"{robot}/agent")
    put_situation(bench, x_m=sign * -2.0, y_m=sign, ball=seen_ball(sign * 6.0, sign * 0.5))
    bench.port("kicker_state").put(ball_held=True)
    bench.iterate()
    command = newest(bench, "skill_command")
    assert command.skill == "shoot"
    assert command.x_m == sign * 11.0
    assert newest(bench, "role").role == "attacker"


def test_agent_numbers_commands_and_repeats_an_unchanged_one() -> None:
    bench = Bench(Agent, "cyan2/agent")
    for x_m in (3.0, 3.0, 3.5):
        put_situation(bench, ball=seen_ball(x_m, 0.0))
        bench.iterate()
    assert [command.command_id for command in bench.port("skill_command").sent] == [1, 1, 2]


def test_agent_asks_again_when_a_skill_has_failed() -> None:
    bench = Bench(Agent, "cyan2/agent")
    for status in (skill_status_t.RUNNING, skill_status_t.FAILED, skill_status_t.RUNNING):
        put_situation(bench, ball=seen_ball(3.0, 0.0))
        bench.port("skill_status").put(status=status, command_id=1, skill="get_ball")
        bench.iterate()
    assert [command.command_id for command in bench.port("skill_command").sent] == [1, 2, 2]


@pytest.mark.parametrize(("robot", "sign"), [("cyan2", 1.0), ("magenta2", -1.0)])
def test_skiller_speaks_in_the_world_frame(robot: str, sign: float) -> None:
    bench = Bench(Skiller, f"{robot}/skiller")
    put_situation(bench)
    bench.port("skill_command").put(command_id=1, skill="mark", x_m=sign * -5.0)
    bench.iterate()
    target: drive_target_t = newest(bench, "drive_target")
    assert not target.stop
    assert target.x_m == pytest.approx(sign * -5.9)
    assert newest(bench, "skill_status").command_id == 1


def test_without_a_command_the_robot_stands_and_does_not_kick() -> None:
    bench = Bench(Skiller, "cyan2/skiller")
    bench.iterate()
    assert newest(bench, "drive_target").stop
    assert newest(bench, "skill_status").status == skill_status_t.INACTIVE
    kick = newest(bench, "kick_command")
    assert (kick.kick_id, kick.speed_m_s, kick.dribble) == (0, 0.0, False)


def test_kicks_are_numbered_on_from_the_kickers_newest() -> None:
    bench = Bench(Skiller, "cyan2/skiller")
    for _ in range(3):
        put_situation(bench, ball=seen_ball(0.33, 0.0))
        bench.port("kicker_state").put(ball_held=True, charged=True, kick_id=6)
        bench.port("skill_command").put(command_id=1, skill="shoot", x_m=11.0)
        bench.iterate()
    kicks = [(kick.kick_id, kick.speed_m_s > 0) for kick in bench.port("kick_command").sent]
    assert (7, True) in kicks
    assert sum(fires for _, fires in kicks) == 1


def senseless(value: float, message: Any) -> Any:
    """Fills every number with a fraction, also those of what the message contains."""
    for name, kind, dimensions in zip(message.__slots__, message.__typenames__, message.__dimensions__, strict=True):
        if kind == "double" and dimensions is None:
            setattr(message, name, value)
        elif kind == "boolean":
            setattr(message, name, name != "stop")
        elif name == "ball":
            senseless(value, getattr(message, name))
        elif kind.endswith("robot_estimate_t"):
            setattr(message, name, [senseless(value, robot_estimate_t()) for _ in range(3)])
    if hasattr(message, "mates"):
        message.mate_roles = ["attacker"] * 3
        message.localized = True
    return message


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300, -1e300, 1e5])
@pytest.mark.parametrize("component", [Navigator, Skiller, Agent, Referee])
def test_senseless_numbers_do_no_harm(component: type[Component], value: float) -> None:
    bench = Bench(component, "cyan2/component")
    for skill in ("get_ball", "intercept", "shoot", "pass", "dribble", "keep_goal", "mark", "goto"):
        for declared in bench.declaration.ports:
            if not declared.writes:
                message = senseless(value, bench.port(declared.attribute).message_type())
                message.header.time_us = bench.time_us
                if declared.attribute == "skill_command":
                    message.skill, message.command_id = skill, bench.tick
                if declared.attribute == "game_state":
                    message.state, message.stopped = game_state_t.PLAY, False
                bench.port(declared.attribute).put(message)
        bench.iterate()
        if component is Navigator:
            command = newest(bench, "motor_command")
            assert math.hypot(command.vx_m_s, command.vy_m_s) <= 3.1
            assert abs(command.omega_rad_s) <= 5.1


def test_stopped_navigator_leaves_the_motors_off() -> None:
    bench = navigate(5, x_m=5.0, heading_rad=math.pi / 2)
    bench.finalize()
    command = newest(bench, "motor_command")
    assert (command.enabled, command.vx_m_s, command.vy_m_s, command.omega_rad_s) == (False, 0.0, 0.0, 0.0)


def test_stopped_skiller_leaves_no_target_kick_or_handling() -> None:
    bench = Bench(Skiller, "cyan2/skiller")
    bench.component.kick_command.value.kick_id = 3
    bench.component.kick_command.value.dribble = True
    bench.finalize()
    kick = newest(bench, "kick_command")
    assert (kick.kick_id, kick.speed_m_s, kick.dribble) == (3, 0.0, False)
    assert newest(bench, "drive_target").stop

"""Limits of the rules as settings: another value leads to another decision."""

from typing import Any

import pytest

from procs.model.events import Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team
from procs.referee import restarts
from procs.referee.positions import misplaced
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from tests.procs.referee.script import CYAN, MAGENTA, TICK_S, Script

CENTRE = Point(0.0, 0.0)


@pytest.mark.parametrize(
    ("state", "robot", "x_m", "nearer"),
    [
        (State.FREE_KICK, "cyan2", 1.5, {"own_m": 1.5}),
        (State.FREE_KICK, "magenta2", 2.5, {"theirs_m": 2.5}),
        (State.DROP_BALL, "cyan2", 0.5, {"dropped_m": 0.5}),
        (State.FREE_KICK, "magenta2", 2.5, {"tolerance_m": 0.6}),
        (State.KICK_OFF, "cyan2", 1.5, {"tolerance_m": 1.6}),
    ],
)
def test_places_that_robots_keep_are_settings(state: State, robot: str, x_m: float, nearer: dict[str, float]) -> None:
    restart = Restart(state, Team.NONE if state is State.DROP_BALL else CYAN, CENTRE)
    robots = {"cyan1": Point(-1.2, 0.0), robot: Point(x_m, 0.0)}
    assert misplaced(restart, robots) == [robot]
    assert misplaced(restart, robots, rules=Rules.model_validate(nearer)) == []


@pytest.mark.parametrize(("intrusion_m", "reasons"), [(0.3, []), (0.1, ["too near to a set piece"])])
def test_way_that_repeats_a_set_piece_is_a_setting(intrusion_m: float, reasons: list[str]) -> None:
    script = Script(intrusion_m=intrusion_m).started()
    script.robots["magenta2"] = Point(2.8, 0.0)
    script.tick()
    assert script.reasons == reasons


@pytest.mark.parametrize("repeats", [0, 1, 2, 3])
def test_number_of_repeats_is_a_setting(repeats: int) -> None:
    script = Script(repeats=repeats)
    for _ in range(5):
        script.started()
        script.robots["magenta2"] = Point(1.0, 0.0)
        script.tick()
        script.robots["magenta2"] = Point(4.0, 2.0)
    assert (len(script.reasons), script.whistle.stopped) == (repeats, False)


def test_spots_of_set_pieces_are_settings() -> None:
    rules = Rules(corner_inset_m=1.0, throw_in_inset_m=0.5, free_kick_inset_m=2.0)
    at_line = Point(3.0, 6.9)
    assert restarts.corner_kick(CYAN, Point(11.0, 1.0), rules).spot == (10.0, 6.0)
    assert restarts.after_side_line(at_line, CYAN, rules).spot == (3.0, 6.5)
    assert restarts.after_foul(at_line, CYAN, rules).spot == (3.0, 5.0)
    assert restarts.ball_left_there(at_line, rules).spot == (3.0, 5.0)
    assert restarts.after_goal_line(Point(11.2, 1.0), MAGENTA, rules, Ends()).spot == (10.0, 6.0)


@pytest.mark.parametrize(
    ("way_m", "pause_s", "settings", "reasons"),
    [
        (0.0, 0.4, {}, []),
        (0.0, 0.4, {"lost_s": 0.6}, ["dribbling"]),
        (0.3, 0.05, {}, ["dribbling"]),
        (0.3, 0.05, {"free_m": 0.2}, []),
    ],
)
def test_end_of_carrying_is_a_setting(
    way_m: float, pause_s: float, settings: dict[str, float], reasons: list[str]
) -> None:
    script = Script(**settings).playing()
    script.carry("cyan3", script.ball.x_m + 2.0)
    script.ball = Point(script.ball.x_m + way_m, 0.0)
    script.wait(pause_s)
    script.carry("cyan3", script.ball.x_m + 1.5)
    assert script.reasons == reasons


@pytest.mark.parametrize(("won_s", "goals"), [(0.5, 0), (0.1, 1)])
def test_time_after_which_a_rival_has_the_ball_is_a_setting(won_s: float, goals: int) -> None:
    script = Script(won_s=won_s).started()
    script.touch("cyan2")
    script.roll(1.0, 0.0)
    for _ in range(6):
        script.touch("magenta2")
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert script.score == (goals, 0)


@pytest.mark.parametrize(
    ("gap_m", "speed_m_s", "settings", "reasons"),
    [
        (0.004, 0.5, {}, ["pushing"]),
        (0.004, 0.5, {"contact_m": 0.001}, []),
        (0.004, 0.5, {"apart_m": 0.002}, []),
        (0.01, 0.5, {"contact_m": 0.015}, ["pushing"]),
        (0.004, 0.5, {"shove_m_s": 0.6}, []),
    ],
)
def test_contact_of_a_push_is_a_setting(
    gap_m: float, speed_m_s: float, settings: dict[str, float], reasons: list[str]
) -> None:
    script = Script(**settings).playing()
    pair, apart_m = ("cyan2", "magenta2"), 2 * script.whistle.rules.robot.radius_m + gap_m
    for tick in range(20):
        script.robots |= {pair[0]: Point(0.025 * tick, 4.0), pair[1]: Point(0.025 * tick + apart_m, 4.0)}
        script.tick(**dict.fromkeys(pair, Point(speed_m_s, 0.0)))
    assert script.reasons == reasons


@pytest.mark.parametrize(
    ("back_m_s", "settings", "reasons"),
    [
        (-0.15, {}, []),
        (-0.15, {"still_m_s": 0.2}, ["holding"]),
        (0.2, {"holding_s": 9.0}, ["holding"]),
        (0.2, {"holding_s": 9.0, "back_m_s": 0.3}, []),
    ],
)
def test_speed_of_a_ball_that_is_held_is_a_setting(back_m_s: float, settings: Any, reasons: list[str]) -> None:
    script = Script(deadlock_s=60.0, **settings).playing()
    for _ in range(round(1.7 / TICK_S)):
        script.ball = Point(script.ball.x_m - back_m_s * TICK_S, 0.0)
        script.robots["cyan3"] = Point(script.ball.x_m - 0.33, 0.0)
        script.touch("cyan3", Kind.TOUCH)
    assert script.reasons == reasons

"""Commands that the skills cannot carry out."""

import math
from typing import Any

import pytest

from lcmtypes.soccer import skill_command_t
from procs.behaviour.bodies import USUAL
from procs.behaviour.commands import accepted_place, mistake
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import FIELD


def found(**command: Any) -> str:
    return mistake(skill_command_t(**command), FIELD, USUAL)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ({"skill": "goto", "x_m": 99.0}, "x_m is 99; between the walls a robot's middle can be from -11.75 to 11.75"),
        ({"skill": "goto", "y_m": -7.9}, "y_m is -7.9; between the walls a robot's middle can be from -7.75 to 7.75"),
        (
            {"skill": "goto", "x_m": 11.2},
            "(11.2, 0) is in a goal; at that y_m x_m can be from -10.9 to 10.9",
        ),
        (
            {"skill": "goto", "x_m": -11.7, "y_m": 0.5},
            "(-11.7, 0.5) is behind a goal; at that y_m x_m can be from -10.9 to 10.9",
        ),
        (
            {"skill": "dribble", "x_m": 11.2},
            "(11.2, 0) is in a goal; at that y_m x_m can be from -10.9 to 10.9",
        ),
        ({"skill": "pass", "x_m": 12.5}, "x_m is 12.5; between the walls the place can be from -12 to 12"),
        ({"skill": "pass", "speed_m_s": -3.0}, "speed_m_s is -3; it should be above 0, or 0 for the skill's own speed"),
        ({"skill": "goto", "x_m": 2e4}, "x_m is 20000; it should be a number between -10000 and 10000"),
        ({"skill": "stop", "speed_m_s": math.inf}, "speed_m_s is inf; it should be a number between -10000 and 10000"),
        ({"skill": "goto", "speed_m_s": -1.0}, "speed_m_s is -1; it should be above 0, or 0 for the skill's own speed"),
    ],
)
def test_reason_says_what_is_wrong_and_what_would_do(command: dict[str, Any], reason: str) -> None:
    assert found(**command) == reason


def test_pass_faster_than_the_kicker_can_is_a_mistake() -> None:
    reason = found(skill="pass", speed_m_s=20.0)
    fastest_m_s = float(reason.removesuffix(" at most").rpartition(" ")[2])
    assert 6.0 < fastest_m_s < 12.0
    assert not found(skill="pass", speed_m_s=fastest_m_s - 0.1)


@pytest.mark.parametrize("skill", ["goto", "dribble"])
def test_drive_that_the_agent_orders_stays_before_a_goal(skill: str) -> None:
    assert accepted_place(skill, Point(11.3, 0.4), FIELD, USUAL) == (10.9, 0.4)
    assert accepted_place(skill, Point(11.3, 2.0), FIELD, USUAL) == (11.3, 2.0)


def test_place_that_is_only_aimed_at_may_lie_outside() -> None:
    assert not found(skill="clear", x_m=12.5)
    assert accepted_place("clear", Point(12.5, 0.0), FIELD, USUAL) == (12.5, 0.0)


@pytest.mark.parametrize("skill", ["goto", "dribble", "mark", "block", "search", "aim", "pass", "push"])
def test_accepted_place_is_no_mistake(skill: str) -> None:
    place = accepted_place(skill, Point(-30.0, 9.0), FIELD, USUAL)
    assert not found(skill=skill, x_m=place.x_m, y_m=place.y_m)


@pytest.mark.parametrize("skill", ["goto", "dribble", "mark", "block", "search", "aim", "pass", "push"])
@pytest.mark.parametrize("x_m", [math.nan, math.inf, 2e4])
def test_senseless_place_stays_a_mistake(skill: str, x_m: float) -> None:
    place = accepted_place(skill, Point(x_m, 0.0), FIELD, USUAL)
    assert found(skill=skill, x_m=place.x_m, y_m=place.y_m).startswith(f"x_m is {x_m:g}; ")

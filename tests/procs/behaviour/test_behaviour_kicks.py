"""Kicks that the kicker refuses, and clearances by the size of the field."""

import pytest

from procs.behaviour.ball_play import BallPlay
from procs.behaviour.passing import Passing
from procs.behaviour.skills.playing import Shoot
from procs.behaviour.skills.skill import Scene, Status
from procs.model.field import Field, Point
from tests.procs.behaviour.behaviour_parts import ball, robot, view

OWN = robot("cyan2", 0.0, 0.0)


def held(heading_rad: float = 0.0, duration_s: float = 0.05, kicked: bool | None = None) -> Scene:
    seen = view(OWN._replace(heading_rad=heading_rad), ball(0.33, 0.0))
    return Scene(seen, Point(8.0, 0.0), 0.0, holds_ball=True, duration_s=duration_s, kicked=kicked)


def test_kick_refused_at_once_is_aimed_anew() -> None:
    skill = Shoot()
    assert skill.step(held()).kick_m_s > 0.0
    off = [skill.step(held(2.0, kicked=False)._replace(holds_ball=False)) for _ in range(10)]
    assert [step.kick_m_s for step in off] == [0.0] * 10
    assert off[-1].status is Status.FAILED, "it has lost the ball"


def test_kick_refused_at_once_is_asked_for_again() -> None:
    skill = Shoot()
    kicks = [skill.step(held(kicked=False if tick else None)).kick_m_s for tick in range(7)]
    assert [kick > 0.0 for kick in kicks] == [True, False] * 3 + [True]


@pytest.mark.parametrize("rate_hz", [10, 20, 100])
def test_turn_while_waiting_for_the_kicker_is_not_a_jerk(rate_hz: int) -> None:
    """A heading that changed by 0.008 rad in 0.2 s is a slow turn, which leaves the robot on target."""
    skill, duration_s = Shoot(), 1.0 / rate_hz
    assert skill.step(held(0.0, duration_s)).kick_m_s > 0.0
    ticks = round(0.2 / duration_s)
    for tick in range(1, ticks):
        assert skill.step(held(0.008 * tick / ticks, duration_s)).kick_m_s == 0.0
    assert skill.step(held(0.008, duration_s, kicked=False)).kick_m_s > 0.0


@pytest.mark.parametrize(("off_rad", "kicks"), [(0.08, True), (0.2, False)])
def test_robot_that_cannot_turn_shoots_nearly_aimed(off_rad: float, kicks: bool) -> None:
    skill = Shoot()
    steps = [skill.step(held(off_rad)) for _ in range(30)]
    assert not any(step.kick_m_s for step in steps[:16]), "it has time to turn"
    assert any(step.kick_m_s for step in steps) == kicks


@pytest.mark.parametrize(("length_m", "width_m"), [(22.0, 14.0), (12.0, 8.0), (32.0, 20.0)])
def test_pressed_robot_clears_by_the_size_of_the_field(length_m: float, width_m: float) -> None:
    field = Field(length_m=length_m, width_m=width_m)
    for share, clears in ((0.3, True), (0.34, False)):
        place = Point(share * length_m - length_m / 2, 0.0)
        own, rival = robot("cyan2", *place), robot("", place.x_m + 1.0, 0.3)
        play, seen = BallPlay(field, Passing()), view(own, ball(place.x_m + 0.33, 0.0), (), (rival,))
        play.watch(seen, True, 0.05)
        assert (play.decide(seen).skill == "clear") == clears, share

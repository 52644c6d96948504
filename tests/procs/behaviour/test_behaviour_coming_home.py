"""Robots that come home past a ball near their own goal: none pushes it in."""

import math

import pytest

from procs.behaviour.posts import PLAY
from procs.behaviour.roles import GOALKEEPER
from procs.behaviour.skills.getting import GetBall
from procs.behaviour.skills.keeping import KeepGoal
from procs.behaviour.skills.skill import Drive, Scene, Step
from procs.behaviour.tactics import Tactics
from procs.behaviour.view import View
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import FIELD, ball, job, robot, view


def scene(seen: View) -> Scene:
    return Scene(seen, Point(-8.7, 0.0), 0.0)


def drive(step: Step) -> Drive:
    assert step.drive is not None
    return step.drive


def test_keeper_beyond_the_ball_goes_back_before_it_around_it() -> None:
    seen = (view(robot("cyan1", x_m, 0.0), ball(-9.5, 0.0)) for x_m in (-10.0, -8.0))
    before, beyond = (drive(KeepGoal().step(scene(each))) for each in seen)
    assert not before.avoid_ball
    assert beyond.avoid_ball
    assert beyond.place.x_m < -9.5


@pytest.mark.parametrize(("speed_m_s", "skill"), [(0.5, "get_ball"), (3.0, "keep_goal")])
def test_keeper_that_comes_home_fast_does_not_run_into_the_ball(speed_m_s: float, skill: str) -> None:
    keeper = robot("cyan1", -8.0, 0.0, role=GOALKEEPER)._replace(velocity_m_s=Point(-speed_m_s, 0.0))
    seen = view(keeper, ball(-9.3, 0.0), (), (robot("", 0.0, 0.0),))
    assert Tactics(FIELD).decide(seen, PLAY, job(GOALKEEPER), False, 0.05).skill == skill


@pytest.mark.parametrize(("ball_x_m", "stays_beyond"), [(-9.5, True), (-8.5, False)])
def test_contested_ball_before_the_own_goal_is_not_run_through(ball_x_m: float, stays_beyond: bool) -> None:
    own, rival = robot("cyan1", -7.0, 0.0, math.pi), robot("", ball_x_m, 0.4)
    place = drive(GetBall().step(scene(view(own, ball(ball_x_m, 0.0), (), (rival,))))).place
    assert (place.x_m > ball_x_m) == stays_beyond

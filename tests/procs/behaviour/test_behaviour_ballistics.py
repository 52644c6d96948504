"""Kicks and interceptions against the physics of the simulated ball."""

import math

import pymunk
import pytest

from procs.behaviour import aim, ballistics
from procs.behaviour.bodies import USUAL
from procs.behaviour.view import Ball
from procs.model.ball import BALL, BallModel
from procs.model.field import Point
from procs.model.robot import ROBOT
from procs.simulation.physics.ball_body import Ball as Flight
from procs.simulation.physics.rolling import RollingFriction
from tests.procs.behaviour.behaviour_parts import FIELD, robot, view

OWN = robot("cyan2", 0.0, 0.0)


@pytest.mark.parametrize("distance_m", [3.0, 6.0, 9.0])
def test_kicked_ball_arrives_with_the_wanted_speed(distance_m: float) -> None:
    friction, way_m, step_s = RollingFriction(BallModel()), 0.0, 0.001
    speed_m_s = ballistics.kick_speed_m_s(distance_m, 2.0, USUAL)
    while way_m < distance_m:
        speed_m_s, _ = friction.advance(speed_m_s, 0.0, step_s)
        way_m += speed_m_s * step_s
    assert speed_m_s == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("distance_m", [2.0, 4.0, 6.0, 8.0])
def test_lob_comes_to_the_goal_between_keeper_and_bar(distance_m: float) -> None:
    ball = Flight(pymunk.Space(), BallModel())
    lob = ballistics.lob(distance_m, USUAL)
    ball.vz_m_s, x_m, clear_m = lob.lift_m_s, 0.0, math.nan
    while x_m < distance_m:
        ball.fall(0.001)
        x_m += lob.speed_m_s * 0.001
        if math.isnan(clear_m) and ball.z_m > ROBOT.height_m:
            clear_m = x_m
    assert ROBOT.height_m + 0.05 < ball.z_m < FIELD.goal_height_m - 2 * BALL.radius_m - 0.05
    assert lob.clear_m(ROBOT.height_m) == pytest.approx(clear_m, abs=0.05)
    assert lob.clear_m(3.0) == math.inf


def test_rolling_ball_is_predicted() -> None:
    friction, x_m, speed_m_s = RollingFriction(BallModel()), 0.0, 2.0
    friction.roll(2.0, 0.0)
    for _ in range(2000):
        speed_m_s, _ = friction.advance(speed_m_s, 0.0, 0.001)
        x_m += speed_m_s * 0.001
    ball = Ball(known=True, velocity_m_s=Point(2.0, 0.0))
    assert ballistics.ball_after(ball, 2.0, USUAL).x_m == pytest.approx(x_m, abs=0.02)
    assert ballistics.ball_after(ball, 60.0, USUAL).x_m == pytest.approx(5.0, abs=0.01)  # v^2 / 2a: it stops


def test_distances_and_times_agree() -> None:
    for distance_m in (0.0, 0.5, 2.5, 8.0):
        assert ballistics.way_m(ballistics.reach_s(distance_m)) == pytest.approx(distance_m)


def test_interception_of_a_resting_ball_is_at_the_ball() -> None:
    meeting = ballistics.meet(view(OWN, Ball(known=True, place=Point(3.0, 4.0))))
    assert meeting.place == (3.0, 4.0)
    assert meeting.time_s == pytest.approx(ballistics.reach_s(5.0 - ROBOT.held_ball_m(BALL)))


def test_interception_of_a_passing_ball_is_ahead_of_it() -> None:
    ball = Ball(known=True, place=Point(-4.0, 1.0), velocity_m_s=Point(2.5, 0.0))
    meeting = ballistics.meet(view(OWN, ball))
    assert -1.0 < meeting.place.x_m < 0.5
    assert ballistics.reach_s(math.dist(meeting.place, (0.0, 0.0)) - ROBOT.held_ball_m(BALL)) <= meeting.time_s


def test_ball_that_outruns_the_robot_is_met_at_the_end() -> None:
    ball = Ball(known=True, place=Point(5.0, 0.0), velocity_m_s=Point(6.0, 0.0))
    meeting = ballistics.meet(view(OWN, ball))
    assert meeting.place == ballistics.ball_after(ball, 4.0, USUAL)
    assert meeting.time_s > 4.0


def test_ball_that_shoots_past_a_robot_is_met_from_every_place() -> None:
    """Between two steps it once jumped over a robot, which was the attacker in every other tick."""
    where = Ball(known=True, place=Point(0.0, 0.2), velocity_m_s=Point(9.4, 0.0))
    course = ballistics.Course(where, USUAL)
    for step in range(60):
        place = Point(2.0 + 0.05 * step, 0.0)
        meeting = course.meet(place)
        assert meeting.time_s == pytest.approx(place.x_m / 9.4, abs=0.1)
        assert math.dist(meeting.place, place) < 0.5


@pytest.mark.parametrize(("limit_m_s", "away_m", "possible"), [(12, 10.5, True), (8, 4.0, True), (8, 10.0, False)])
def test_weak_kicker_cannot_lob_from_far_away(limit_m_s: float, away_m: float, possible: bool) -> None:
    bodies = USUAL._replace(kick_limit_m_s=limit_m_s)
    assert ballistics.lob(away_m, bodies).is_possible(bodies) == possible
    start = Point(FIELD.half_length_m - away_m, 0.0)
    assert (aim.best_lob(start, [], FIELD, bodies).free_rad > 0.0) == possible


def test_lob_that_would_be_too_steep_is_impossible() -> None:
    assert not ballistics.lob(0.9, USUAL).is_possible(USUAL)

"""Interception: where a robot waits for a rolling ball, and how steadily it keeps to that place."""

import math

import numpy as np
import pytest

from procs.behaviour.interception import Interception
from procs.behaviour.view import Ball
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import ball, robot, view


def test_crossing_ball_is_awaited_ahead_of_where_it_is() -> None:
    stand = Interception().stand(view(robot("cyan2", -1.0, 0.0), ball(0.0, -4.0, 0.0, 3.0)), 0.05)
    assert stand is not None
    assert stand.place.x_m == pytest.approx(0.0)
    assert -2.0 < stand.place.y_m < 2.0
    assert stand.heading_rad == pytest.approx(-math.pi / 2)  # the mouth is turned to the ball


def test_ball_that_rests_or_runs_away_is_not_awaited() -> None:
    plan, own = Interception(), robot("cyan2", 0.0, 0.0)
    assert plan.stand(view(own, ball(2.0, 0.0)), 0.05) is None
    assert plan.stand(view(own, ball(1.0, 0.0, 2.0, 0.0)), 0.05) is None


def test_fast_ball_is_awaited_where_the_robot_stands() -> None:
    stand = Interception().stand(view(robot("cyan2", 0.0, 0.0), ball(6.0, 0.2, -3.5, 0.0)), 0.05)
    assert stand is not None
    assert stand.place == pytest.approx((0.0, 0.2), abs=0.01)


def test_fast_ball_is_awaited_where_the_robot_can_stop() -> None:
    """A robot that drove across the ball's way braked only on the way itself, and the ball bounced off beside it."""
    own = robot("cyan2", 0.0, 0.6)._replace(velocity_m_s=Point(0.4, -1.6))
    stand = Interception().stand(view(own, ball(5.0, 0.2, -3.5, 0.0)), 0.05)
    assert stand is not None
    assert stand.place == pytest.approx((0.1, 0.2), abs=0.01)


def test_place_stays_while_the_measured_velocity_is_noisy() -> None:
    rng, plan, places = np.random.default_rng(1), Interception(), []
    for tick in range(16):
        noise = 0.2 * rng.standard_normal(2)
        seen = ball(0.0, -4.0 + 0.15 * tick, float(noise[0]), 3.0 + float(noise[1]))
        own = robot("cyan2", -0.8 + 0.05 * tick, 0.0, -0.1 * tick)
        stand = plan.stand(view(own, plan.smoothed(seen, 0.05)), 0.05)
        if tick >= 4 and stand:
            places.append(stand.place)
    assert len(places) == 12
    assert max(math.dist(one, two) for one in places for two in places) < 1.2


def test_kick_is_followed_at_once() -> None:
    plan = Interception()
    plan.smoothed(ball(0.0, 0.0), 0.05)
    kicked = Ball(known=True, place=Point(0.3, 0.0), velocity_m_s=Point(6.0, 0.0))
    assert plan.smoothed(kicked, 0.05) == kicked

"""Friction and bounce of the ball come from the settings of the world model."""

import math

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.flight import Flight
from tests.procs.world_model.eyes import PERIOD_S
from tests.procs.world_model.team_on_bench import Robot


def kicked_m_s(**friction: float) -> float:
    """Returns the speed of a ball half a second after a kick of 6 m/s that no camera sees."""
    tracker = BallTracker(BALL.model_copy(update=friction))
    tracker.advance(PERIOD_S, 2.0)
    tracker.hold("me", np.array((0.33, 0.0, 0.0, 0.0)), np.eye(4) * 1e-4)
    tracker.kick(np.array((6.0, 0.0)))
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0)
    return math.hypot(*tracker.track.state[2:])


def test_ball_that_slides_hard_is_soon_slow() -> None:
    usual_m_s = kicked_m_s()
    assert usual_m_s == pytest.approx(4.5, abs=0.2)
    assert kicked_m_s(sliding_m_s2=1.5) == pytest.approx(usual_m_s + 0.75, abs=0.1)


def test_slide_of_a_solid_ball_ends_sooner() -> None:
    assert kicked_m_s(sliding_m_s2=8.0, inertia=0.4) > kicked_m_s(sliding_m_s2=8.0) + 0.3


def test_dead_ball_does_not_bounce() -> None:
    flight = Flight.of_kick(3.0)
    assert flight is not None
    flies_s = 2 * 3.0 / 9.81
    bounced, _ = flight.moved(flies_s + 0.05, BALL)
    assert bounced is not None
    assert bounced.lift_m_s == pytest.approx(0.6 * 3.0 - 9.81 * 0.05, abs=0.01)
    lies, grounded_s = flight.moved(flies_s + 0.05, BALL.model_copy(update={"bounce": 0.1}))
    assert lies is None
    assert grounded_s == pytest.approx(0.05)


def test_another_ball_in_the_settings_begins_a_new_track() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(5):
        robot.sense(np.array((2.0, 0.0)), [])
        robot.bench.iterate()
    component = robot.bench.component
    track = component._ball.tracker
    component.config_changed()
    assert component._ball.tracker is track, "other settings leave the ball as it is"
    component.config.ball = BALL.model_copy(update={"sliding_m_s2": 2.0})
    component.config_changed()
    assert component._ball.tracker.ball.sliding_m_s2 == 2.0
    robot.sense(np.array((2.0, 0.0)), [])
    robot.bench.iterate()
    assert robot.world.ball.x_m == pytest.approx(2.0, abs=0.1)

"""The ball's two phases of friction against the formulas for constant deceleration."""

import math
from itertools import pairwise

import pytest

from procs.model.ball import BallModel
from procs.simulation.physics.rolling import RollingFriction

BALL = BallModel()


def run(friction: RollingFriction, vx_m_s: float, vy_m_s: float, step_s: float = 0.005) -> list[tuple[float, float]]:
    velocities = [(vx_m_s, vy_m_s)]
    while velocities[-1] != (0.0, 0.0) and len(velocities) < 20_000:
        velocities.append(friction.advance(*velocities[-1], step_s))
    return velocities


@pytest.mark.parametrize("speed_m_s", [2.0, 5.0, 10.0])
def test_kicked_ball_rolls_as_far_as_the_formula_says(speed_m_s: float) -> None:
    way_m = sum(vx * 0.005 for vx, _ in run(RollingFriction(BALL), speed_m_s, 0.0))
    rolling_m_s = speed_m_s / (1 + BALL.inertia)
    expected_m = (speed_m_s**2 - rolling_m_s**2) / (2 * BALL.sliding_m_s2) + rolling_m_s**2 / (2 * BALL.rolling_m_s2)
    assert way_m == pytest.approx(expected_m, rel=0.01)


def test_ball_rolls_from_six_tenths_of_its_first_speed() -> None:
    speeds = [vx for vx, _ in run(RollingFriction(BALL), 5.0, 0.0)]
    losses = [(before - after) / 0.005 for before, after in pairwise(speeds)]
    assert losses[0] == pytest.approx(3.0)
    turning_point = next(speed for speed, loss in zip(speeds, losses, strict=False) if loss < 1.0)
    assert turning_point == pytest.approx(0.6 * 5.0, abs=0.02)


def test_ball_that_rolls_already_does_not_slide() -> None:
    friction = RollingFriction(BALL)
    friction.roll(2.0, 0.0)
    assert friction.advance(2.0, 0.0, 0.1)[0] == pytest.approx(2.0 - 0.4 * 0.1)


def test_deflected_ball_keeps_its_old_spin_and_is_turned_by_it() -> None:
    friction = RollingFriction(BALL)
    friction.roll(3.0, 0.0)
    velocities = run(friction, 0.0, 3.0)
    assert max(vx for vx, _ in velocities) == pytest.approx(3.0 * BALL.inertia / (1 + BALL.inertia), rel=0.05)


def test_step_size_does_not_change_the_path() -> None:
    coarse = sum(vx * 0.01 for vx, _ in run(RollingFriction(BALL), 4.0, 0.0, 0.01))
    fine = sum(vx * 0.001 for vx, _ in run(RollingFriction(BALL), 4.0, 0.0, 0.001))
    assert coarse == pytest.approx(fine, rel=0.01)


def test_ball_comes_to_rest() -> None:
    velocities = run(RollingFriction(BALL), 1.0, -1.0)
    assert velocities[-1] == (0.0, 0.0)
    assert all(math.hypot(*after) <= math.hypot(*before) for before, after in pairwise(velocities))

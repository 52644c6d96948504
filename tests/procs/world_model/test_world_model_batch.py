"""Filters in a batch give the same results as filterpy's functions one by one."""

import numpy as np
import pytest
from numpy.typing import NDArray

from procs.model.ball import BALL
from procs.model.estimation import predict, update
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import passes
from procs.world_model.batch import corrected, innovation
from procs.world_model.robot_tracks import RobotTracks

Floats = NDArray[np.float64]
AGE_S = 0.12
SEEN_AS = np.kron(np.array((1.0, -AGE_S, AGE_S**2 / 2)), np.eye(2))


def test_batch_equals_the_library() -> None:
    rng = np.random.default_rng(1)
    roots = rng.standard_normal((6, 6, 6))
    covariances = roots @ roots.transpose(0, 2, 1)
    states, positions_m = rng.standard_normal((6, 6)), rng.standard_normal((6, 2))
    spreads = np.tile(np.diag((0.04, 0.09)), (6, 1, 1))
    found = innovation(states, covariances, positions_m, spreads, AGE_S)
    after = corrected(states, covariances, found)
    for track in range(6):
        expected = update(states[track], covariances[track], positions_m[track], spreads[track], H=SEEN_AS)
        assert after[0][track] == pytest.approx(expected[0], abs=1e-9)
        assert after[1][track] == pytest.approx(expected[1], abs=1e-9)
        difference = positions_m[track] - SEEN_AS @ states[track]
        spread = SEEN_AS @ covariances[track] @ SEEN_AS.T + spreads[track]
        assert found.surprises[track] == pytest.approx(difference @ np.linalg.solve(spread, difference))
        assert found.determinants[track] == pytest.approx(np.linalg.det(spread))


def singer(duration_s: float) -> tuple[Floats, Floats]:
    """Returns motion and noise (6, 6) of a robot whose acceleration lasts 0.35 s, by many short steps."""
    steps, rates = 400, np.kron(np.array(((0, 1, 0), (0, 0, 1), (0, 0, -1 / 0.35))), np.eye(2))
    noise_1_s = np.kron(np.diag((0.0, 0.1, 2 * 3.0**2 / 0.35)), np.eye(2))
    step_s = duration_s / steps
    short, motion, noise = np.eye(6) + rates * step_s, np.eye(6), np.zeros((6, 6))
    for _ in range(steps):
        motion, noise = short @ motion, short @ noise @ short.T + noise_1_s * step_s
    return motion, noise


def test_tracks_equal_filters_of_the_library() -> None:
    rng = np.random.default_rng(3)
    tracks, spread = RobotTracks(), np.eye(2) * 0.05**2
    motion, noise = singer(0.05)
    state, covariance = np.zeros(6), np.diag((0.05**2, 0.05**2, 1.5**2, 1.5**2, 3.0**2, 3.0**2))
    tracks.see(np.zeros((1, 2)), spread[None])
    for step in range(1, 20):
        position_m = np.array((0.05 * step, 0.0)) + 0.02 * rng.standard_normal(2)
        tracks.predict(0.05, 1.0)
        tracks.see(position_m[None], spread[None])
        state, covariance = predict(state, covariance, F=motion, Q=noise)
        state, covariance = update(state, covariance, position_m, spread, H=np.eye(2, 6))
    assert tracks.states[0] == pytest.approx(state[:4], abs=0.02)
    assert tracks.covariances[0] == pytest.approx(covariance[:4, :4], rel=0.08, abs=1e-4)


@pytest.mark.slow
def test_mixture_equals_the_estimator_of_the_library() -> None:
    from filterpy.kalman import IMMEstimator, KalmanFilter

    rng = np.random.default_rng(4)
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01, BALL)
    roots = 0.3 * rng.standard_normal((4, 7, 7))
    track._x, track._p = 0.1 * rng.standard_normal((4, 7)), roots @ roots.transpose(0, 2, 1) + 0.01 * np.eye(7)
    track._weights = np.array((0.1, 0.5, 0.3, 0.1))
    moves = passes(0.05, contact=1.0, slow=False, flies=False)
    filters = []
    for state, covariance in zip(track._x, track._p, strict=True):
        made = KalmanFilter(dim_x=7, dim_z=2)
        made.x, made.P, made.F, made.Q = state.copy(), covariance.copy(), np.eye(7), np.zeros((7, 7))
        made.H, made.R = np.eye(2, 7), np.eye(2) * 0.04
        filters.append(made)
    library = IMMEstimator(filters, track.weights.copy(), moves)
    library.predict()
    track._mix(moves)
    for number, made in enumerate(filters):
        assert track._x[number] == pytest.approx(made.x, abs=1e-9)
        assert track._p[number] == pytest.approx(made.P, abs=1e-9)
    library.update(np.array((0.2, -0.1)))
    assert track.see(np.array((0.2, -0.1)), np.eye(2) * 0.04)
    assert track.weights == pytest.approx(library.mu, abs=1e-5)
    assert track.state == pytest.approx(library.x[:4], abs=1e-5)
    assert track.covariance == pytest.approx(library.P[:4, :4], abs=1e-5)

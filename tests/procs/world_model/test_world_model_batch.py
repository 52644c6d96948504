"""Filters in a batch give the same results as filterpy's functions one by one."""

import numpy as np
import pytest

from procs.model.estimation import predict, update
from procs.world_model.ball_filter import BallFilter, _passes
from procs.world_model.batch import corrected, drift, innovation
from procs.world_model.robot_tracks import RobotTracks

AGE_S = 0.12
SEEN_AS = np.array(((1.0, 0.0, -AGE_S, 0.0), (0.0, 1.0, 0.0, -AGE_S)))


def test_batch_equals_the_library() -> None:
    rng = np.random.default_rng(1)
    roots = rng.standard_normal((6, 4, 4))
    covariances = roots @ roots.transpose(0, 2, 1)
    states, positions_m = rng.standard_normal((6, 4)), rng.standard_normal((6, 2))
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


def test_drift_equals_the_library() -> None:
    root = np.random.default_rng(2).standard_normal((4, 4))
    covariance, motion = root @ root.T, np.eye(4)
    motion[0, 2] = motion[1, 3] = 0.05
    _, expected = predict(np.zeros(4), covariance, F=motion, Q=0)
    batch = covariance[None].copy()
    drift(batch, 0.05)
    assert batch[0] == pytest.approx(expected)


def test_tracks_equal_filters_of_the_library() -> None:
    rng = np.random.default_rng(3)
    tracks, motion, spread = RobotTracks(), np.eye(4), np.eye(2) * 0.05**2
    motion[0, 2] = motion[1, 3] = 0.05
    noise = np.kron(np.array(((0.05**3 / 3, 0.05**2 / 2), (0.05**2 / 2, 0.05))), np.eye(2)) * 1.25
    state, covariance = np.zeros(4), np.diag((0.05**2, 0.05**2, 1.5**2, 1.5**2))
    tracks.see(np.zeros((1, 2)), spread[None])
    for step in range(1, 20):
        position_m = np.array((0.05 * step, 0.0)) + 0.02 * rng.standard_normal(2)
        tracks.predict(0.05, 1.0)
        tracks.see(position_m[None], spread[None])
        state, covariance = predict(state, covariance, F=motion, Q=noise)
        state, covariance = update(state, covariance, position_m, spread, H=np.eye(2, 4))
    assert tracks.states[0] == pytest.approx(state, abs=1e-9)
    assert tracks.covariances[0] == pytest.approx(covariance, abs=1e-9)


@pytest.mark.slow
def test_mixture_equals_the_estimator_of_the_library() -> None:
    from filterpy.kalman import IMMEstimator, KalmanFilter

    rng = np.random.default_rng(4)
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01)
    roots = 0.3 * rng.standard_normal((4, 7, 7))
    track._x, track._p = 0.1 * rng.standard_normal((4, 7)), roots @ roots.transpose(0, 2, 1) + 0.01 * np.eye(7)
    track._weights = np.array((0.1, 0.5, 0.3, 0.1))
    moves = _passes(0.05, contact=1.0, slow=False)
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

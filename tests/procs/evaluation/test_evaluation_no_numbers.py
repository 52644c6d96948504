"""Measures of beliefs that are no numbers, of matrices that are no covariances, and of messages that are missing."""

import math

import numpy as np
import pytest

from lcmtypes.soccer import ball_percept_t, pose_t, robot_estimate_t
from procs.evaluation.beliefs import believed, covers, surprise_of
from procs.evaluation.innovations import innovations
from procs.evaluation.piece import Piece
from procs.evaluation.table import high_95, rms, root_99
from tests.procs.evaluation.pieces import FIRST, model, piece, robot

NO_COVARIANCES = {
    "zero": [[0.0, 0.0], [0.0, 0.0]],
    "singular": [[1.0, 0.0], [0.0, 0.0]],
    "negative": [[-1.0, 0.0], [0.0, -1.0]],
    "indefinite": [[1.0, 5.0], [5.0, 1.0]],
    "NaN": [[math.nan, 0.0], [0.0, 1.0]],
    "infinite": [[math.inf, 0.0], [0.0, math.inf]],
}


def believing(ball_m: tuple[float, float], matrix: list[list[float]] | None = None) -> Piece:
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=2, vx_m_s=0.0)
    estimate = model(ball_m)
    if matrix:
        estimate.ball.covariance = [[*matrix[0], 0.0, 0.0], [*matrix[1], 0.0, 0.0], [0.0] * 4, [0.0] * 4]
    made.by_robot = {"world_model": {"cyan1": dict.fromkeys(made.truth, estimate)}}
    return made


@pytest.mark.parametrize("matrix", NO_COVARIANCES.values(), ids=NO_COVARIANCES.keys())
def test_matrix_that_is_no_covariance_covers_nothing(matrix: list[list[float]]) -> None:
    error = np.array((0.1, 0.0))
    assert (surprise_of(np.array(matrix), error), covers(np.array(matrix), error)) == (math.inf, False)
    samples = believed(believing((0.1, 0.0), matrix))
    assert samples["inside 95 %, all"].tolist() == [0.0, 0.0]
    assert samples["ball, squared error by its covariance"].tolist() == []


@pytest.mark.parametrize("x_m", [math.nan, math.inf])
def test_ball_that_is_no_place_is_infinitely_wrong(x_m: float) -> None:
    samples = believed(believing((x_m, 0.0)))
    assert rms(samples["ball resting, position"]) == math.inf
    assert samples["inside 95 %, all"].tolist() == [0.0, 0.0]


def test_opponent_that_is_no_place_does_not_exist() -> None:
    made = piece([robot("cyan1", 0.0, 0.0), robot("magenta1", 1.0, 0.0)], ticks=2, vx_m_s=0.0)
    estimate = model((0.0, 0.0), opponents=[robot_estimate_t(x_m=math.nan, y_m=0.0)])
    made.by_robot = {"world_model": {"cyan1": dict.fromkeys(made.truth, estimate)}}
    samples = believed(made)
    assert samples["opponents that do not exist"].tolist() == [1.0, 1.0]
    assert (samples["opponents known"].tolist(), samples["opponents, position"].tolist()) == ([0.0, 0.0], [])


@pytest.mark.parametrize(
    "pose", [(math.nan, 0.0, 0.0), (0.0, math.inf, 0.0), (0.0, 0.0, math.nan), (0.0, 0.0, math.inf)]
)
def test_pose_that_is_none_is_wrong(pose: tuple[float, float, float]) -> None:
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=3, vx_m_s=0.0)
    x_m, y_m, heading_rad = pose
    told = pose_t(localized=True, x_m=x_m, y_m=y_m, heading_rad=heading_rad)
    made.by_robot = {"pose": {"cyan1": dict.fromkeys(made.truth, told)}}
    samples = believed(made)
    assert (samples["wrong pose believed"][:, 0].tolist(), samples["pose jumps"][:, 0].tolist()) == ([1.0], [0.0])
    assert (rms(samples["pose, position"]), rms(samples["pose, heading"])) == (math.inf, math.inf)


def test_frame_of_a_tick_without_a_pose_has_no_innovation() -> None:
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=4, vx_m_s=0.0)
    percept = ball_percept_t(visible=True, x_m=0.1, covariance_m2=[[0.01, 0.0], [0.0, 0.01]])
    percept.header.time_us, percept.capture_us = (FIRST + 2) * 50_000, (FIRST + 1) * 50_000
    made.by_robot = {
        "world_model": {"cyan1": dict.fromkeys(made.truth, model((0.0, 0.0)))},
        "ball_percept": {"cyan1": {FIRST + 2: percept}},
        "pose": {"cyan1": {FIRST + 1: pose_t(localized=True)}},
    }
    assert innovations(made)["ball innovations, correlation of successive"].tolist() == []


def test_quantiles_of_infinite_samples_are_infinite() -> None:
    few = np.array([0.01, 0.04, math.inf])
    assert (high_95(few), root_99(few)) == (math.inf, math.inf)
    assert (high_95(np.array([math.inf])), high_95(np.array([0.1] * 99 + [math.inf]))) == (math.inf, 0.1)

"""Frames of single cameras: balls that are found, balls that do not exist, and innovations."""

import math
from typing import Any

import numpy as np
import pytest

from lcmtypes.soccer import (
    ball_candidate_t,
    ball_percept_t,
    ground_truth_t,
    pose_t,
    true_robot_t,
    world_model_t,
)
from procs.evaluation.exposures import frames_of, pose_at, pose_between, scene_at
from procs.evaluation.innovations import innovations
from procs.evaluation.piece import Piece
from procs.evaluation.sightings import sightings
from procs.model.robot import RobotModel

PERIOD_S, FIRST, COUNT = 0.05, 100, 40
TICKS = range(FIRST, FIRST + COUNT)


def piece_with(ball_m: tuple[float, float], percept: ball_percept_t, **others: true_robot_t) -> Piece:
    """Returns a piece in which cyan1 stands at (1, 0), looks along y, and reports the same in each tick."""
    made = Piece(PERIOD_S)
    robots = [true_robot_t(name="cyan1", x_m=1.0, heading_rad=math.pi / 2), *others.values()]
    made.truth = {
        tick: ground_truth_t(robots=robots, ball_x_m=ball_m[0], ball_y_m=ball_m[1])
        for tick in range(FIRST - 2, TICKS.stop)
    }
    made.by_robot["ball_percept"] = {"cyan1": dict.fromkeys(TICKS, percept)}
    return made


def seeing(x_m: float, y_m: float, **values: Any) -> ball_percept_t:
    """Returns a percept of a ball in the robot's frame, seen 20 ms ago."""
    made = ball_percept_t(visible=True, x_m=x_m, y_m=y_m, covariance_m2=(np.eye(2) * 0.01).tolist(), **values)
    made.header.time_us, made.capture_us = 10_000_000, 9_980_000
    return made


def shares(piece: Piece) -> dict[str, float]:
    return {name: float(values.mean()) for name, values in sightings(piece).items() if len(values)}


def test_ball_at_its_place_is_found() -> None:
    found = shares(piece_with((1.0, 2.0), seeing(2.0, 0.1)))
    assert found == {"ball found in a frame, up to 2.5 m": 1.0, "balls that do not exist, a frame": 0.0}


def test_ball_elsewhere_does_not_exist() -> None:
    found = shares(piece_with((1.0, 4.0), seeing(-4.0, 0.0)))
    assert found == {"ball found in a frame, 2.5 to 5 m": 0.0, "balls that do not exist, a frame": 1.0}


def test_less_likely_ball_counts_as_found() -> None:
    percept = seeing(-4.0, 0.0, others=[ball_candidate_t(x_m=6.0)], n_others=1)
    found = shares(piece_with((1.0, 6.0), percept))
    assert found == {"ball found in a frame, 5 to 7.5 m": 1.0, "balls that do not exist, a frame": 1.0}


def test_hidden_ball_need_not_be_found() -> None:
    blind = ball_percept_t(visible=False)
    rival = true_robot_t(name="magenta1", x_m=1.1, y_m=1.5)
    assert shares(piece_with((1.0, 3.0), blind)) == {
        "ball found in a frame, 2.5 to 5 m": 0.0,
        "balls that do not exist, a frame": 0.0,
    }
    assert shares(piece_with((1.0, 3.0), blind, rival=rival)) == {"balls that do not exist, a frame": 0.0}


def test_ball_beside_a_slim_robot_has_to_be_found() -> None:
    rival, blind = true_robot_t(name="magenta1", x_m=1.2, y_m=1.5), ball_percept_t(visible=False)
    made = piece_with((1.0, 3.0), blind, rival=rival)
    assert "ball found in a frame, 2.5 to 5 m" not in shares(made)
    made.model = RobotModel(radius_m=0.15)
    assert shares(made)["ball found in a frame, 2.5 to 5 m"] == 0.0


def test_ball_in_the_air_is_not_counted() -> None:
    made = piece_with((1.0, 2.0), seeing(5.0, 5.0))
    for truth in made.truth.values():
        truth.ball_z_m = 0.4
    assert shares(made) == {}


def test_truth_is_that_of_the_exposure() -> None:
    """The robot drives 0.1 m and turns by 0.2 rad in a tick; the exposure was two fifths of a tick ago."""
    made = piece_with((5.0, 0.0), seeing(4.0, 0.0))
    for tick, truth in made.truth.items():
        truth.robots = [true_robot_t(name="cyan1", x_m=0.1 * (tick - FIRST), heading_rad=3.1 + 0.2 * (tick - FIRST))]
    frame = next(frames_of(made))
    assert frame.tick == FIRST
    assert frame.exposed == pytest.approx(FIRST - 0.4)
    scene = scene_at(made, "cyan1", frame.exposed)
    assert scene is not None
    assert np.hypot(*scene.ball_m) == pytest.approx(5.04)
    assert math.atan2(scene.ball_m[1], scene.ball_m[0]) == pytest.approx(-3.02)
    assert scene_at(made, "cyan1", FIRST - 10.4) is None
    assert scene_at(made, "cyan9", frame.exposed) is None


def test_headings_turn_the_shorter_way() -> None:
    middle = pose_between(np.array((0.0, 0.0, 3.1)), np.array((1.0, 0.0, -3.1)), 0.5)
    assert middle.tolist() == pytest.approx([0.5, 0.0, math.pi])


def test_lost_robot_has_no_pose() -> None:
    poses = {1: pose_t(localized=True), 2: pose_t(localized=False)}
    assert pose_at(poses, 1.0) is not None
    assert pose_at(poses, 1.5) is None


def believing_piece(errors_m: list[float]) -> Piece:
    """Returns a piece in which cyan1 expects the ball 2 m ahead and sees it wrong by one of the errors, in turn."""
    made = piece_with((1.0, 2.0), seeing(2.0, 0.0))
    seen = {tick: seeing(2.0 + errors_m[tick % len(errors_m)], 0.0) for tick in TICKS}
    made.by_robot["ball_percept"] = {"cyan1": seen}
    model = world_model_t()
    model.ball.known, model.ball.x_m, model.ball.y_m = True, 1.0, 2.0
    made.by_robot["world_model"] = {"cyan1": dict.fromkeys(TICKS, model)}
    pose = pose_t(localized=True, x_m=1.0, heading_rad=math.pi / 2)
    made.by_robot["pose"] = {"cyan1": dict.fromkeys(range(FIRST - 2, TICKS.stop), pose)}
    return made


@pytest.mark.parametrize(("period_s", "every", "products"), [(0.01, 8, 3), (0.04, 2, 18), (0.1, 1, 38), (0.05, 4, 0)])
def test_successive_innovations_are_frames_up_to_012_s_apart(
    period_s: float, every: int, products: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("procs.evaluation.exposures.START_S", 0.0)
    piece = believing_piece([0.1])
    piece.period_s = period_s
    percept = seeing(2.1, 0.0)
    percept.capture_us = percept.header.time_us - round(period_s * 1e6)
    piece.by_robot["ball_percept"] = {"cyan1": dict.fromkeys(TICKS[::every], percept)}
    (found,) = innovations(piece).values()
    assert len(found) == products


@pytest.mark.parametrize(("errors_m", "correlation"), [([0.1, 0.1], 1.0), ([0.1, -0.1], -1.0), ([0.1, 9.0], 1.0)])
def test_innovations_that_repeat_are_correlated(errors_m: list[float], correlation: float) -> None:
    """Frames with another ball, which no filter would use, do not count."""
    (products,) = innovations(believing_piece(errors_m)).values()
    summed, squares = products.sum(axis=0)
    assert squares / len(products) == pytest.approx(1.0)
    assert summed / squares == pytest.approx(correlation)

"""Poses in game pieces with known errors: robots that are carried away, stand, or leave their true way."""

import math

import numpy as np
import pytest

from lcmtypes.soccer import ground_truth_t, pose_t, true_robot_t
from procs.evaluation.match import samples_of
from procs.evaluation.piece import Piece
from procs.evaluation.poses import pose_samples
from procs.evaluation.table import rows_of

FIRST = 100  # tick; measuring begins some seconds after the start


def robot(x_m: float, vx_m_s: float = 0.0) -> true_robot_t:
    return true_robot_t(name="cyan1", x_m=x_m, vx_m_s=vx_m_s)


def believes(x_m: float, localized: bool = True) -> pose_t:
    made = pose_t()
    made.x_m, made.localized = x_m, localized
    return made


def carried_piece(ticks: int = 220) -> Piece:
    """Makes a piece in which the robot is set down 5 m away in its tenth tick."""
    made = Piece(0.05)
    for tick in range(FIRST, FIRST + ticks):
        truth = made.truth[tick] = ground_truth_t()
        truth.robots = [robot(5.0 if tick >= FIRST + 10 else 0.0)]
    return made


def test_carried_robot_is_found_once_its_pose_is_right() -> None:
    made = carried_piece()
    at = [(0.0, True)] * 20 + [(0.0, False)] * 10 + [(5.1, True)] * 190
    made.by_robot["pose"] = {"cyan1": {FIRST + i: believes(*each) for i, each in enumerate(at)}}
    found = pose_samples(made)
    assert found["kidnapped, time until found"].tolist() == pytest.approx([1.0])  # from the tenth tick to the thirtieth
    assert found["kidnapped, found within 10 s"].tolist() == [1.0]
    assert found["wrong pose believed"][0, 0] == 0, "it could not know at once"
    assert np.sqrt(found["pose, position"].max()) == pytest.approx(0.1)
    assert found["pose known"].sum() == 10 + 190


@pytest.mark.parametrize("every", [1, 2, 5])
def test_poses_of_some_ticks_tell_the_same(every: int) -> None:
    """A localization with `every` says nothing in the ticks between its iterations; the robot drives meanwhile."""
    made = carried_piece(ticks=221)
    for tick, truth in made.truth.items():
        truth.robots = [robot(truth.robots[0].x_m + (tick - FIRST) * 0.05 * 3.0, 3.0)]
    at = {tick: believes(truth.robots[0].x_m, not 10 <= tick - FIRST < 30) for tick, truth in made.truth.items()}
    at[FIRST + 200].x_m += 2.0
    made.by_robot["pose"] = {"cyan1": {tick: pose for tick, pose in at.items() if tick % every == 0}}
    found = pose_samples(made)
    assert found["kidnapped, time until found"].tolist() == pytest.approx([1.0])
    assert found["wrong pose believed"][0] == pytest.approx([1, 0.05 * 201 / 60 / 1000], rel=0.03)
    assert found["pose jumps"][0] == pytest.approx([2, 0.05 * 201 / 60], rel=0.03)


def test_robot_that_is_turned_by_hand_was_carried() -> None:
    made = carried_piece()
    for tick, truth in made.truth.items():
        truth.robots = [true_robot_t(name="cyan1", x_m=0.2 if tick >= FIRST + 10 else 0.0)]
        truth.robots[0].heading_rad = -2.0 if tick >= FIRST + 10 else 2.0
    told = {tick: believes(0.0) for tick in made.truth}
    for tick, pose in told.items():
        pose.heading_rad = -2.0 if tick >= FIRST + 20 else 2.0
    made.by_robot["pose"] = {"cyan1": told}
    found = pose_samples(made)
    assert found["wrong pose believed"][0, 0] == 0, "it could not know at once"
    assert found["kidnapped, time until found"].tolist() == pytest.approx([0.5])


@pytest.mark.parametrize(("way_m", "turn_rad"), [(0.5, 0.65), (0.1, 0.65), (0.45, 0.3)])
def test_robot_carried_a_short_way_cannot_know_at_once(way_m: float, turn_rad: float) -> None:
    made = carried_piece()
    for tick, truth in made.truth.items():
        after = tick >= FIRST + 10
        truth.robots = [true_robot_t(name="cyan1", x_m=way_m * after, heading_rad=turn_rad * after)]
    made.by_robot["pose"] = {"cyan1": {tick: believes(way_m * (tick >= FIRST + 20)) for tick in made.truth}}
    for tick, pose in made.by_robot["pose"]["cyan1"].items():
        pose.heading_rad = turn_rad * (tick >= FIRST + 20)
    found = pose_samples(made)
    assert (found["wrong pose believed"][0, 0], found["pose jumps"][0, 0]) == (0, 0)
    assert found["kidnapped, time until found"].tolist() == pytest.approx([0.5])


def test_standing_robot_has_rows_of_its_own() -> None:
    made = Piece(0.05)
    for tick in range(FIRST, FIRST + 20):
        made.truth[tick] = ground_truth_t(robots=[robot(0.0, vx_m_s=0.0 if tick < FIRST + 5 else 1.0)])
    made.by_robot["pose"] = {"cyan1": dict.fromkeys(made.truth, believes(0.02))}
    found = pose_samples(made)
    assert found["pose, robot stands, position"].tolist() == pytest.approx([0.0004] * 5)
    assert len(found["pose, position"]) == 20


def test_wrong_place_found_after_a_search_counts_as_believed() -> None:
    made = carried_piece()
    at = [(0.0, True)] * 20 + [(0.0, False)] * 10 + [(-5.0, True)] * 190
    made.by_robot["pose"] = {"cyan1": {FIRST + i: believes(*each) for i, each in enumerate(at)}}
    found = pose_samples(made)
    assert found["wrong pose believed"][0, 0] == 1
    assert found["kidnapped, time until found"].tolist() == [math.inf]


@pytest.mark.parametrize(("found_m", "jumps", "found_s"), [(5.0, 0, 0.65), (4.4, 2, 5.5)])
def test_return_to_the_right_place_is_no_jump(found_m: float, jumps: int, found_s: float) -> None:
    """A robot that finds a place beside the right one jumps there, and to the right one."""
    made = carried_piece()
    at_m = [0.0] * 23 + [found_m] * 97 + [5.0] * 100
    made.by_robot["pose"] = {"cyan1": {FIRST + i: believes(x_m) for i, x_m in enumerate(at_m)}}
    found = pose_samples(made)
    assert found["pose jumps"][0, 0] == jumps
    assert found["kidnapped, time until found"].tolist() == pytest.approx([found_s])


def test_pose_that_leaves_the_true_way_has_jumped() -> None:
    made = carried_piece()
    errors_m = [0.0] * 30 + [0.4] * 30 + [-0.4] * 160
    for tick, truth in made.truth.items():
        truth.robots = [robot(0.1 * tick)]
    told = {FIRST + i: believes(0.1 * (FIRST + i) + error_m) for i, error_m in enumerate(errors_m)}
    made.by_robot["pose"] = {"cyan1": told}
    found = pose_samples(made)
    assert found["pose jumps"].tolist() == [pytest.approx((1, 220 * 0.05 / 60))]
    rows = {row.name: row.value for row in rows_of([samples_of(made)])}
    assert rows["pose, position, 99 %"] == pytest.approx(0.4)
    assert rows["pose, position"] < 0.38

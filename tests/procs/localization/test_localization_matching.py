"""Table of the field's lines, matching of white points, global search and pose filter."""

import math

import numpy as np
import pytest

from procs.localization.global_search import GlobalSearch
from procs.localization.line_map import LineMap, line_map
from procs.localization.line_matching import LinePoints, match
from procs.localization.pose_filter import PoseFilter
from procs.model.frames import Floats, rotation
from tests.procs.localization.localization_parts import (
    FIELD,
    REACH_M,
    FakeRobot,
    paint_m,
)


def test_table_is_exact_near_a_straight_line_and_the_circle() -> None:
    x_m = np.array([-0.31, 0.17, 4.0])
    y_m = np.array([3.0, 4.0, FIELD.half_width_m - FIELD.line_width_m / 2 - 0.2])
    distance_m, _, _ = line_map(FIELD).look_up(x_m, y_m)
    assert np.abs(distance_m) == pytest.approx([0.31, 0.17, 0.2], abs=1e-9)
    on_circle = (FIELD.circle_diameter_m / 2 - FIELD.line_width_m / 2) * rotation(0.7)[:, 0]
    distance_m, _, _ = line_map(FIELD).look_up(on_circle[:1], on_circle[1:])
    assert np.abs(distance_m[0]) < 1e-3


def test_table_knows_every_painted_point() -> None:
    distance_m, _, _ = line_map(FIELD).look_up(paint_m()[:, 0], paint_m()[:, 1])
    assert np.abs(distance_m).max() < 0.05 / math.sqrt(2), "half a cell, where two lines meet"
    assert np.abs(distance_m).mean() < 0.002


def test_match_without_noise_finds_the_pose() -> None:
    robot = FakeRobot(seed=1, clutter=0.0)
    robot.pose = np.array((3.0, -2.0, 0.7))
    seen = (paint_m() - robot.pose[:2]) @ rotation(0.7)
    near = seen[np.hypot(seen[:, 0], seen[:, 1]) < 5.0][::7]
    found = match(line_map(FIELD), LinePoints(near[:, 0], near[:, 1]), np.add(robot.pose, (0.15, -0.1, 0.05))[None])
    assert found.poses[0] == pytest.approx(robot.pose, abs=2e-3)
    assert found.scores[0] > 0.999


def test_line_gives_no_information_about_position_along_it() -> None:
    y_m = np.linspace(-0.7, 1.5, 50)
    found = match(line_map(FIELD), LinePoints(np.zeros(50), y_m), np.array([[0.1, 4.5, 0.0]]))
    information = found.information[0]
    assert information[1, 1] < 0.01 * information[0, 0]
    assert found.poses[0] == pytest.approx((0.0, 4.5, 0.0), abs=0.02)


@pytest.mark.slow
def test_blockwise_table_equals_the_table_of_all_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    places_m = np.random.default_rng(1).uniform((-11.0, -8.0), (11.0, 8.0), (5000, 2))
    by_blocks = LineMap(FIELD).look_up(*places_m.T)
    monkeypatch.setattr("procs.localization.line_map._BLOCK_M", 100.0)  # one block, near to all lines
    assert np.array_equal(by_blocks, LineMap(FIELD).look_up(*places_m.T))


def test_search_finds_the_pose_among_its_first_guesses() -> None:
    robot = FakeRobot(seed=3)
    search = GlobalSearch(line_map(FIELD), REACH_M)
    hits = 0
    for _ in range(20):
        robot.place()
        x_m, y_m = robot.white_points()
        found = search.best(LinePoints(x_m, y_m).thinned(40), np.array([robot.pose[2] + 0.03]), 4)
        hits += bool((np.hypot(*(found[:, :2] - robot.pose[:2]).T) < 0.5).any())
    assert hits >= 18


def test_filter_does_not_depend_on_the_length_of_a_tick() -> None:
    deviations = []
    for ticks in (20, 100):
        pose_filter = PoseFilter(np.zeros(3), (0.01, 0.01, 0.01))
        for _ in range(ticks):
            pose_filter.predict(2.0 / ticks, 0.0, 0.5 / ticks, 1.0 / ticks)
        deviations.append(np.sqrt(np.diag(pose_filter.covariance)))
    assert deviations[0] == pytest.approx(deviations[1], rel=0.1)


def test_push_counts_the_same_with_any_length_of_a_tick() -> None:
    deviations = []
    for ticks in (1, 2, 8):
        pose_filter = PoseFilter(np.zeros(3), (0.01, 0.01, 0.01))
        for frame in range(1, 11):
            for _ in range(ticks):
                pose_filter.predict(0.0, 0.0, 0.0, 0.08 / ticks)
            deviations.append(np.sqrt(np.diag(pose_filter.covariance)))
            pose_filter.correct(np.array((0.04 * frame, 0.0, 0.0)), np.diag((4e-4, 4e-4, 1e-4)), 0.08)
    one, two, eight = np.array(deviations).reshape(3, 10, 3)
    assert two == pytest.approx(one)
    assert eight == pytest.approx(one)
    assert one[-1, 0] > 1.5 * one[-1, 1], "pushed along x"


def deviation_after(ways: tuple[tuple[float, float], ...], scale_sd: float) -> float:
    """Returns the deviation of x after ways ahead and turns, a second each, without a frame."""
    pose_filter = PoseFilter(np.zeros(3), (0.01, 0.01, 0.0))
    for ahead_m, turn_rad in ((0.0, 0.0), *ways):
        for _ in range(25):
            pose_filter.predict(ahead_m / 25, 0.0, turn_rad / 25, 0.04, scale_sd)
    return float(np.sqrt(pose_filter.covariance[0, 0]))


def test_lasting_error_of_wheels_counts_with_the_whole_way() -> None:
    def share(*ways: tuple[float, float]) -> float:
        return math.sqrt(deviation_after(ways, 0.03) ** 2 - deviation_after(ways, 0.0) ** 2)

    assert share((3.0, 0.0)) == pytest.approx(0.09)
    assert share(*[(3.0, 0.0)] * 4) == pytest.approx(0.36)
    assert share((3.0, 0.0), (-2.0, 0.0)) == pytest.approx(0.03)
    assert share((3.0, 0.0), (0.0, math.pi), (2.0, 0.0)) == pytest.approx(0.03)


def after_frames(scale_sd: float, silent_ticks: int, blind_ticks: int) -> Floats:
    """Returns the variance after a silence of the camera, 60 frames and ticks without another one, at 2.5 m/s."""
    pose_filter = PoseFilter(np.zeros(3), (0.01, 0.01, 0.01))
    for ticks in (silent_ticks, *[2] * 60):
        for _ in range(ticks):
            pose_filter.predict(0.1, 0.0, 0.0, 0.04, scale_sd)
        pose_filter.correct(pose_filter.pose, np.diag((4e-4, 4e-4, 1e-4)), 0.04 * ticks)
    for _ in range(blind_ticks):
        pose_filter.predict(0.1, 0.0, 0.0, 0.04, scale_sd)
    return np.diag(pose_filter.covariance)


def test_lasting_error_of_wheels_waits_for_a_missing_frame() -> None:
    assert np.array_equal(after_frames(0.03, 2, 1), after_frames(0.0, 2, 1))


def test_lasting_error_of_wheels_begins_anew_with_a_frame() -> None:
    assert after_frames(0.03, 50, 50) == pytest.approx(after_frames(0.03, 2, 50), rel=1e-6)
    assert after_frames(0.03, 2, 50)[0] > after_frames(0.0, 2, 50)[0] + 0.13**2

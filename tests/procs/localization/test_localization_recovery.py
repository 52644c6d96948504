"""A robot that does not know its pose: search, kidnapping, compass."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench, settings_in, system_of
from lcmtypes.soccer import place_robot_t
from procs.localization.hypotheses import Hypotheses
from procs.localization.localization import Localization
from procs.model.field import Field
from tests.procs.localization.localization_parts import (
    FakeRobot,
    frames,
    until_localized,
)


@pytest.mark.slow
def test_kidnapped_robot_localizes_within_5_s_a_hundred_times() -> None:
    robot = FakeRobot(seed=7)
    robot.place()
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    times = []
    for _ in range(100):
        robot.place()
        times.append(until_localized(bench, robot, 8.0))
    assert np.median(times) <= 2.0
    assert sorted(times)[94] <= 5.0
    assert np.isfinite(times).sum() >= 98


@pytest.mark.slow
def test_repeated_kidnapping_does_not_bias_the_compass() -> None:
    robot = FakeRobot(seed=8)
    robot.place()
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    for _ in range(20):
        heading_rad = robot.pose[2]
        robot.place()
        robot.pose[2] = heading_rad + 0.5
        assert until_localized(bench, robot, 8.0) < math.inf
        assert abs(bench.component._localizer.compass_offset_rad - robot.drift_rad) < 0.15


@pytest.mark.parametrize("place_m", [(13.2, 4.0), (-13.2, -1.0), (0.0, 9.2), (0.0, -9.2)])
def test_robot_far_outside_the_lines_finds_its_place(place_m: tuple[float, float]) -> None:
    robot = FakeRobot(seed=2)
    robot.pose = np.array((*place_m, 1.0))
    assert until_localized(Bench(Localization, field=Field(border_m=3.0)), robot, 5.0) < math.inf


def test_never_localized_without_a_compass_or_without_lines() -> None:
    robot = FakeRobot(seed=9)
    blind = Bench(Localization)
    blind.port("imu").put(heading_rad=0.0)
    blind.iterate(60)
    assert not any(sent.localized for sent in blind.port("pose").sent)
    deaf = Bench(Localization)
    for _ in range(60):
        x_m, y_m = robot.white_points()
        deaf.port("line_points").put(x_m=x_m.tolist(), y_m=y_m.tolist())
        deaf.iterate()
    assert not any(sent.localized for sent in deaf.port("pose").sent)


def test_compass_tells_the_halves_apart() -> None:
    for heading_rad in (0.3, 0.3 - math.pi):
        robot = FakeRobot(seed=11)
        robot.pose = np.array((5.0, 2.0, heading_rad))
        bench = Bench(Localization)
        assert until_localized(bench, robot, 5.0) < math.inf
        assert np.hypot(*robot.error(bench)[:2]) < 0.15


def test_compass_that_contradicts_the_pose_starts_a_search() -> None:
    robot = FakeRobot(seed=15)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench = Bench(Localization, start_x_m=-2.0, start_y_m=-1.0, start_heading_rad=0.5 - math.pi)
    assert until_localized(bench, robot, 5.0) < math.inf, "it began as the mirror image of the true pose"


@pytest.mark.parametrize("wrong_rad", [1.0, math.pi])
def test_one_wrong_reading_of_the_compass_loses_no_pose(wrong_rad: float) -> None:
    robot = FakeRobot(seed=3)
    robot.place()
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    for error_rad in (wrong_rad, -wrong_rad):
        robot.drift_rad += error_rad
        assert all(frames(bench, robot, 1))
        robot.drift_rad -= error_rad
        assert all(frames(bench, robot, 10))


def test_wrong_heading_and_a_worse_fit_show_a_carried_robot() -> None:
    """One that was carried to lines like those of its old place fits it half."""
    robot = FakeRobot(seed=3)
    robot.place()
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    robot.clutter = 0.3
    assert all(frames(bench, robot, 1))
    robot.drift_rad += 1.5
    assert not any(frames(bench, robot, 1))


def turning(bench: Bench, robot: FakeRobot, compass_every: int, ticks: int) -> bool:
    """Turns a robot with frames in even ticks and headings in odd ones; returns whether it knows its place at last."""
    for tick in range(ticks):
        robot.drive(np.array((0.0, 0.0, 2.0)))
        robot.show(bench)
        if not compass_every or tick % compass_every != 1:
            bench.port("imu").waiting.clear()
        if tick % 2:
            bench.port("line_points").waiting.clear()
        bench.iterate()
    return bool(bench.port("pose").sent[-1].localized and np.hypot(*robot.error(bench)[:2]) < 0.3)


@pytest.mark.parametrize("begun_in_the_other_half", [False, True])
@pytest.mark.parametrize("compass_every", [2, 8])
def test_compass_may_come_in_other_ticks_than_frames(compass_every: int, begun_in_the_other_half: bool) -> None:
    """A robot that turns needs the turn since a heading of 0.4 s ago."""
    robot = FakeRobot(seed=15)
    robot.pose = np.array((2.0, 1.0, 0.5))
    wrong: dict[str, Any] = {"start_x_m": -2.0, "start_y_m": -1.0, "start_heading_rad": 0.5 - math.pi}
    bench = Bench(Localization, **(wrong if begun_in_the_other_half else {}))
    assert turning(bench, robot, compass_every, 100)


def test_heading_of_long_ago_does_not_count() -> None:
    bench, robot = Bench(Localization), FakeRobot(seed=15)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench.port("imu").put(heading_rad=0.5)
    bench.iterate(11)
    assert not turning(bench, robot, 0, 100)


@pytest.mark.parametrize("parity", [0, 1])
def test_kidnapping_is_noticed_with_frames_of_every_second_tick(parity: int) -> None:
    """Cameras alternate between ticks: a robot may get its frames in even or in odd ticks only."""
    bench, robot = Bench(Localization, **settings_in("soccer.yaml", "cyan1/localization")), FakeRobot(3)
    robot.pose = np.array((-5.0, 2.0, 0.3))
    known: list[bool] = []
    for tick in range(240):
        if tick == 100:
            robot.pose = np.array((4.0, -3.0, 0.3))
        robot.drive(np.zeros(3))
        robot.show(bench)
        if tick % 2 != parity:
            bench.port("line_points").waiting.clear()
        bench.iterate()
        known.append(bench.port("pose").sent[-1].localized)
    assert known[99]
    assert not all(known[100:180]), "carried 10 m away"
    assert known[-1]
    assert np.hypot(*robot.error(bench)[:2]) < 0.3


@pytest.mark.parametrize("carried_to", [(4.0, -3.0, 0.3), (3.103, -3.089, 2.942)], ids=["not turned", "turned"])
def test_robot_without_compass_is_declared_lost(carried_to: tuple[float, float, float]) -> None:
    """Turned, it matched the lines of a wrong place: it looked for better ones with its old heading only."""
    start = {"start_x_m": -5.0, "start_y_m": 2.0, "start_heading_rad": 0.3}
    bench, robot = Bench(Localization, **settings_in("soccer.yaml", "cyan1/localization") | start), FakeRobot(4)
    known: list[bool] = []
    for tick in range(200):
        robot.pose = np.array((-5.0, 2.0, 0.3) if tick < 60 else carried_to)
        robot.drive(np.zeros(3))
        robot.show(bench)
        bench.port("imu").waiting.clear()
        bench.iterate()
        known.append(bench.port("pose").sent[-1].localized)
    assert all(known[10:60])
    assert not known[-1]


@pytest.mark.parametrize("interval_s", [0.02, 0.08, 0.12])
def test_decision_takes_as_long_at_any_frame_rate(interval_s: float) -> None:
    hypotheses, poses, taken_s = Hypotheses(), np.array([[1.0, 2.0, 0.3], [5.0, -2.0, 0.3]]), 0.0
    scores = np.array([0.9, 0.2])
    hypotheses.update(poses, scores, interval_s)
    while hypotheses.decided(0.5) is None and taken_s < 3.0:
        hypotheses.update(poses, scores, interval_s)
        taken_s += interval_s
    assert 0.35 < taken_s < 0.39 + interval_s


@pytest.mark.parametrize("interval_s", [0.02, 0.08])
def test_small_lead_decides_once_it_was_kept_for_long(interval_s: float) -> None:
    hypotheses, poses, taken_s = Hypotheses(), np.array([[5.0, 6.5, 0.3], [-6.0, 6.5, 0.3]]), 0.0
    scores = np.array([0.99, 0.975])
    while hypotheses.decided(0.5) is None and taken_s < 5.0:
        hypotheses.update(poses, scores, interval_s)
        taken_s += interval_s
    assert 2.9 < taken_s < 3.1 + interval_s
    assert hypotheses.known[0].pose[0] == 5.0


def test_small_lead_that_changes_never_decides() -> None:
    hypotheses, poses = Hypotheses(), np.array([[5.0, 6.5, 0.3], [-6.0, 6.5, 0.3]])
    scores = np.array([0.99, 0.96])
    hypotheses.update(poses, scores, 0.08)
    for _ in range(10):
        scores = scores[::-1]
        for _ in range(25):
            order = [0 if each.pose[0] > 0 else 1 for each in hypotheses.known]
            hypotheses.update(poses[order], scores[order], 0.08)
            assert hypotheses.decided(0.5) is None


@pytest.mark.parametrize("interval_s", [0.02, 0.08])
def test_scores_fade_in_seconds_not_in_frames(interval_s: float) -> None:
    hypotheses, pose = Hypotheses(), np.array([[1.0, 2.0, 0.3]])
    hypotheses.update(pose, np.array([1.0]), interval_s)
    for _ in range(round(0.48 / interval_s)):
        hypotheses.update(pose, np.array([0.0]), interval_s)
    assert hypotheses.known[0].score == pytest.approx(0.85**6, rel=0.01)


@pytest.mark.parametrize("tick", [0, 500])
def test_start_counts_at_the_beginning_of_a_run_only(tick: int) -> None:
    """A localization that is started again in the middle knows where the robot was, not where it is."""
    robot = FakeRobot(seed=3)
    robot.pose = np.array((-8.0, -6.0, 0.0)) if tick == 0 else np.array((1.7, -5.3, 0.0))
    bench = Bench(Localization, start_x_m=-8.0, start_y_m=-6.0, start_heading_rad=0.0)
    bench.tick, bench.time_us = tick, 50_000 * tick
    assert frames(bench, robot, 3) == [tick == 0] * 3
    assert until_localized(bench, robot, 5.0) < math.inf
    known = [sent for sent in bench.port("pose").sent if sent.localized]
    assert all(math.hypot(sent.x_m - robot.pose[0], sent.y_m - robot.pose[1]) < 0.5 for sent in known)


@pytest.mark.parametrize("place", [(-1.0, -7.7, 2.8), (-1.6, -7.6, -1.8)])
def test_robot_beside_a_touch_line_is_not_half_a_field_away(place: tuple[float, float, float]) -> None:
    """The robot sees a touch line and another line across: the halfway line, or a goal line."""
    x_m, y_m, heading_rad = place
    parts = ("world/simulator", "world/referee", *(f"cyan1/{each}" for each in ("base", "percepts", "localization")))
    still = ("carried_every_s=0", "speed_m_s=0", "turn_rad_s=0")
    system = system_of(
        "kidnapped.yaml", (*parts, "cyan1/wanderer").__contains__, 1, [f"*/wanderer.{each}" for each in still]
    )
    system.tick(50)
    system.come_in("world/place_robot@outside", place_robot_t(robot="cyan1", x_m=x_m, y_m=y_m, heading_rad=heading_rad))
    believed = []
    for _ in range(150):
        system.tick()
        pose = system.newest("cyan1/pose")
        believed.append((pose.localized, math.dist((pose.x_m, pose.y_m), (x_m, y_m)) < 0.3))
    lost = believed.index((False, False))
    assert believed[-1] == (True, True)
    assert (True, False) not in believed[lost:]


def test_small_lead_of_the_past_decides_nothing() -> None:
    """A robot that was set down elsewhere while it was lost has mean scores of its former place."""
    hypotheses, poses = Hypotheses(), np.array(((3.0, 7.0, 0.0), (-8.0, 7.0, 0.0)))
    hypotheses.update(poses, np.array((0.9, 0.8)), 0.0)
    for scores, decides in (((0.9, 0.8), True), ((0.98, 0.99), False)):
        for _ in range(35 if decides else 1):
            hypotheses.update(poses, np.array(scores), 0.08)
        assert (hypotheses.decided(0.5) is not None) is decides

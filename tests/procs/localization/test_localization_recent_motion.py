"""Points of old exposures: the way since then, and what becomes of points whose way is not known."""

import itertools
import math
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench
from procs.localization.localization import Localization
from procs.localization.recent_motion import MEMORY_US, RecentMotion
from procs.localization.self_localizer import Motion
from procs.model.geometry import wrap_rad
from procs.model.units import US_PER_S
from tests.procs.localization.localization_parts import PERIOD_S, FakeRobot, frames, until_localized, wander

TICK_US = 40_000


def circle(turn_rad: float, radius_m: float, ticks: int) -> RecentMotion:
    """Motions along a circle to the left, the robot looking ahead."""
    made = RecentMotion()
    step_rad = turn_rad / ticks
    chord_m = 2 * radius_m * math.sin(step_rad / 2)
    for tick in range(ticks):
        made.add(tick * TICK_US, (tick + 1) * TICK_US, Motion(chord_m, 0.0, step_rad, 1.0))
    return made


@pytest.mark.parametrize("turn_rad", [0.5, math.pi / 2, math.pi])
def test_way_along_a_circle_ends_where_the_circle_does(turn_rad: float) -> None:
    way = circle(turn_rad, 2.0, 20).since(0)
    assert way is not None
    assert way.shift_m == pytest.approx((2 * math.sin(turn_rad), 2 * (1 - math.cos(turn_rad))))
    assert way.turn_rad == pytest.approx(turn_rad)


def test_way_begins_within_a_tick() -> None:
    made = RecentMotion()
    made.add(0, TICK_US, Motion(0.04, 0.0, 0.0, 1.0))
    made.add(TICK_US, 2 * TICK_US, Motion(0.08, 0.02, 0.0, 2.0))
    way = made.since(TICK_US // 4)
    assert way is not None
    assert way.shift_m == pytest.approx((0.03 + 0.08, 0.02))


def test_way_from_before_everything_known_is_not_known() -> None:
    assert RecentMotion().since(0) is None
    long = circle(0.1, 100.0, 2 * MEMORY_US // TICK_US)
    assert long.since(0) is None
    assert long.since(2 * MEMORY_US - MEMORY_US // 2) is not None


@pytest.mark.parametrize(
    "settings",
    [
        ("*/percepts.latency_s=0.6",),
        pytest.param(("*/percepts.latency_s=1", "period_s=0.02"), marks=pytest.mark.slow),
    ],
)
def test_robot_with_a_slow_camera_drives_and_knows_its_place(settings: tuple[str, ...]) -> None:
    errors, surprises = wander(1, settings)
    assert len(errors) > 100
    assert math.sqrt(np.square(errors[:, :2]).sum(axis=1).mean()) < 0.1
    assert np.mean(surprises) < 6.0, "3 for an honest covariance"


def localized(seed: int) -> tuple[Bench, FakeRobot]:
    bench, robot = Bench(Localization), FakeRobot(seed)
    robot.pose = np.array((3.0, 2.0, 0.0))
    assert until_localized(bench, robot, 5.0) < math.inf
    frames(bench, robot, 20)
    return bench, robot


def test_points_count_where_a_robot_that_swings_was_then() -> None:
    """Two ticks after the exposure the turn of the last tick alone tells a wrong way."""
    bench, robot = localized(11)
    exposed: list[dict[str, Any]] = []
    errors_rad, rates_rad_s = [], [4.0 * math.sin(tick / 2) for tick in range(101)]
    for tick, (before_rad_s, rate_rad_s) in enumerate(itertools.pairwise(rates_rad_s)):
        robot.drive(np.array((0.0, 0.0, (before_rad_s + rate_rad_s) / 2)))
        robot.show(bench)
        bench.port("imu").put(heading_rad=wrap_rad(robot.pose[2]), yaw_rate_rad_s=rate_rad_s)
        x_m, y_m = robot.white_points()
        now_us = round(bench.time_us + PERIOD_S * US_PER_S)
        exposed.append({"x_m": x_m.tolist(), "y_m": y_m.tolist(), "capture_us": now_us})
        bench.port("line_points").put(**exposed[max(0, tick - 2)])
        bench.iterate()
        errors_rad.append(robot.error(bench)[2])
    assert np.std(errors_rad[10:]) < 0.02


def test_points_of_an_exposure_long_ago_are_not_believed() -> None:
    bench, robot = localized(7)
    for _ in range(20):
        robot.show(bench)
        x_m, y_m = robot.white_points()
        old_us = round(bench.time_us - 2 * MEMORY_US)
        bench.port("line_points").put(x_m=(x_m + 0.2).tolist(), y_m=y_m.tolist(), capture_us=old_us)
        bench.iterate()
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


def test_same_exposure_a_second_time_tells_nothing_new() -> None:
    bench, robot = localized(8)
    x_m, y_m = robot.white_points()
    seen = {"x_m": x_m.tolist(), "y_m": y_m.tolist(), "capture_us": round(bench.time_us)}
    robot.show(bench)
    bench.port("line_points").put(**seen)
    bench.iterate()
    deviations = [float(np.trace(bench.port("pose").sent[-1].covariance))]
    for _ in range(3):
        robot.show(bench)
        bench.port("line_points").put(**seen)
        bench.iterate()
        deviations.append(float(np.trace(bench.port("pose").sent[-1].covariance)))
    assert deviations == sorted(deviations)
    assert deviations[0] < deviations[-1]


def test_earlier_exposures_tell_nothing_new() -> None:
    """Two exposures come in turns, so that none is that of the message before."""
    deviations = []
    for exposures in ((0, 1, 0, 1, 0, 1), (0, 1)):
        bench, robot = localized(8)
        seen: list[dict[str, Any]] = []
        for ahead_s in (-0.06, -0.01):
            x_m, y_m = robot.white_points()
            seen.append(
                {"x_m": x_m.tolist(), "y_m": y_m.tolist(), "capture_us": round(bench.time_us + ahead_s * US_PER_S)}
            )
        for tick in range(6):
            robot.show(bench)
            bench.port("line_points").waiting.clear()
            if tick < len(exposures):
                bench.port("line_points").put(**seen[exposures[tick]])
            bench.iterate()
        deviations.append(bench.port("pose").sent[-1].covariance)
    assert deviations[0] == deviations[1]


def test_exposure_in_the_future_shuts_no_later_ones_out() -> None:
    bench, robot = localized(9)
    robot.show(bench)
    x_m, y_m = robot.white_points()
    coming_us = round(bench.time_us + 10 * MEMORY_US)
    bench.port("line_points").put(x_m=x_m.tolist(), y_m=y_m.tolist(), capture_us=coming_us)
    bench.iterate()
    robot.latency_s = 0.01
    robot.pose = np.add(robot.pose, (0.15, 0.1, 0.1))
    frames(bench, robot, 10)
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


def test_points_still_to_come_are_not_believed() -> None:
    bench, robot = localized(9)
    for _ in range(20):
        robot.show(bench)
        x_m, y_m = robot.white_points()
        coming_us = round(bench.time_us + MEMORY_US)
        bench.port("line_points").put(x_m=(x_m + 0.2).tolist(), y_m=y_m.tolist(), capture_us=coming_us)
        bench.iterate()
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


def test_old_points_need_odometry_to_be_believed() -> None:
    bench, robot = Bench(Localization), FakeRobot(10)
    robot.pose = np.array((3.0, 2.0, 0.0))
    for _ in range(200):
        x_m, y_m = robot.white_points()
        bench.port("imu").put(heading_rad=0.0)
        seen_us = max(1, round(bench.time_us - US_PER_S))
        bench.port("line_points").put(x_m=x_m.tolist(), y_m=y_m.tolist(), capture_us=seen_us)
        bench.iterate()
    assert not bench.port("pose").sent[-1].localized

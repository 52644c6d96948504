"""Self-localization on simulated white points: accuracy, honesty, disturbances, determinism."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.model.errors import PlanError
from fwk.testing import Bench, launch_plan
from procs.localization.localization import Localization, LocalizationConfig
from procs.localization.pose_filter import PoseFilter
from tests.procs.localization.localization_parts import (
    PERIOD_S,
    Course,
    FakeRobot,
    frames,
    until_localized,
    wander,
)


@pytest.mark.slow
def test_standing_robot_knows_its_pose_to_3_cm_and_002_rad() -> None:
    errors = []
    for seed in range(20):
        robot = FakeRobot(seed)
        robot.place()
        bench = Bench(Localization)
        assert until_localized(bench, robot, 5.0) < math.inf, f"robot {seed} at {robot.pose}"
        frames(bench, robot, 20)
        errors.append([(frames(bench, robot, 1), robot.error(bench))[1] for _ in range(20)])
    error = np.array(errors)
    assert np.abs(error.mean(axis=(0, 1)))[:2].max() < 0.03
    assert np.abs(error.mean(axis=(0, 1)))[2] < 0.02
    deviation = np.sqrt(np.mean(error**2, axis=(0, 1)))
    assert deviation[:2].max() < 0.03
    assert deviation[2] < 0.02


@pytest.mark.slow
def test_driving_robot_stays_localized_within_10_cm() -> None:
    robot = FakeRobot(seed=5)
    bench = Bench(Localization, start_x_m=0.0, start_y_m=0.0, start_heading_rad=0.0)
    course = Course(robot)
    errors, nees = [], []
    for _ in range(1200):
        course.step()
        robot.show(bench)
        bench.iterate()
        error = robot.error(bench)
        errors.append(error)
        nees.append(error @ np.linalg.solve(np.array(bench.port("pose").sent[-1].covariance), error))
    squared = np.square(errors)
    assert np.sqrt(squared[:, :2].sum(axis=1).mean()) < 0.10
    assert np.sqrt(squared[:, 2].mean()) < 0.03
    assert np.quantile(np.sqrt(squared[:, :2].sum(axis=1)), 0.99) < 0.30
    assert all(sent.localized for sent in bench.port("pose").sent)
    assert 0.5 < np.mean(nees) < 6.0, "3 for an honest covariance"


@pytest.mark.slow
def test_latency_of_the_camera_does_not_bias_a_driving_robot() -> None:
    """At 2.5 m/s and 2 rad/s the robot drives 9 cm and turns 4 degrees on between exposure and frame."""
    robot = FakeRobot(seed=6)
    robot.latency_s = 0.035
    bench = Bench(Localization, start_x_m=0.0, start_y_m=0.0, start_heading_rad=0.0)
    errors = []
    for tick in range(300):
        robot.drive(np.array((2.5, 0.0, 2.0)) * min(1.0, tick / 20))
        robot.show(bench)
        bench.iterate()
        error = robot.error(bench)
        forward = math.cos(robot.pose[2]) * error[0] + math.sin(robot.pose[2]) * error[1]
        errors.append((forward, error[2]))
    mean = np.mean(errors[40:], axis=0)
    assert np.abs(mean) == pytest.approx((0.0, 0.0), abs=0.02)


def test_pushed_robot_is_followed_without_a_new_search() -> None:
    robot = FakeRobot(seed=13)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench = Bench(Localization, start_x_m=2.0, start_y_m=1.0, start_heading_rad=0.5)
    frames(bench, robot, 20)
    robot.pose = np.add(robot.pose, (0.15, 0.1, 0.1))
    assert all(frames(bench, robot, 5))
    assert np.hypot(*robot.error(bench)[:2]) < 0.04


def test_same_messages_give_the_same_poses() -> None:
    def run() -> list[bytes]:
        robot = FakeRobot(seed=17)
        robot.place()
        bench = Bench(Localization)
        frames(bench, robot, 60)
        return [sent.encode() for sent in bench.port("pose").sent]

    assert run() == run()


def test_incomplete_start_pose_is_refused() -> None:
    with pytest.raises(ValueError, match="belong together"):
        Bench(Localization, start_x_m=1.0)


def start_at(x_m: float, y_m: float, heading_rad: float) -> tuple[str, ...]:
    values = {"x_m": x_m, "y_m": y_m, "heading_rad": heading_rad}
    return tuple(f"*/localization.start_{name}={value}" for name, value in values.items())


@pytest.mark.parametrize(
    ("settings", "mistake"),
    [
        (("*/localization.start_heading_rad=1",), "belong together; give all three or none"),
        (start_at(100, 0, 0), "start_x_m and start_y_m give (100, 0), which is outside the walls"),
        (start_at(1, 0, 90), "start_heading_rad is 90; it should be from -6.28 to 6.28, in radians"),
        (("*/localization.lost_score=0.9",), "good_score of 0.5 should be at least lost_score, which is 0.9"),
    ],
)
def test_impossible_settings_are_refused_at_launch(settings: tuple[str, ...], mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("soccer-percepts.yaml", settings)
    assert mistake in str(raised.value)


@pytest.mark.parametrize(
    "mirror",
    [
        pytest.param("{size_px: 120, view_angle_deg: 86}", marks=pytest.mark.slow),
        "{height_m: 0.4}",
        pytest.param("{size_px: 1000}", marks=pytest.mark.slow),
    ],
)
def test_covariance_is_honest_with_any_mirror(mirror: str) -> None:
    _, surprises = wander(2, (f"shared.mirror={mirror}",))
    assert len(surprises) > 100
    assert np.mean(surprises) < 5.0, "3 for an honest covariance"


def test_blocked_robot_with_turning_wheels_stays_in_place() -> None:
    robot = FakeRobot(seed=19)
    robot.pose = np.array((3.0, 2.0, 0.0))
    bench = Bench(Localization, start_x_m=3.0, start_y_m=2.0, start_heading_rad=0.0)
    frames(bench, robot, 20)
    errors = []
    for _ in range(60):
        robot.measured = np.array((2.0, 0.0, 0.0))
        robot.odometry = np.add(robot.odometry, robot.measured * PERIOD_S)
        robot.show(bench)
        bench.iterate()
        assert bench.port("pose").sent[-1].localized
        errors.append(np.hypot(*robot.error(bench)[:2]))
    assert np.sqrt(np.mean(np.square(errors[5:]))) < 0.06, "the wheels turn 0.1 m a frame"


def test_odometry_that_restarts_does_not_move_the_robot() -> None:
    robot = FakeRobot(seed=21)
    robot.pose = np.array((3.0, 2.0, 0.0))
    robot.odometry = np.array((7.0, -3.0, 2.0))
    bench = Bench(Localization, start_x_m=3.0, start_y_m=2.0, start_heading_rad=0.0)
    frames(bench, robot, 10)
    robot.odometry = np.zeros(3)
    assert all(frames(bench, robot, 10))
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


def stop_and_lose_odometry(bench: Bench, robot: FakeRobot, count: int) -> None:
    """Drives at 2 m/s from (-6, 2), stops the robot, and shows `count` frames without odometry."""
    for _ in range(30):
        robot.drive(np.array((2.0, 0.0, 0.0)))
        robot.show(bench)
        bench.iterate()
    for _ in range(count):
        robot.drive(np.zeros(3))
        robot.show(bench)
        bench.port("odometry").waiting.clear()
        bench.iterate()


def test_odometry_that_restarts_after_a_gap_moves_no_robot() -> None:
    """A robot could have driven the 4 m back to the new origin in the gap."""
    robot = FakeRobot(seed=6)
    robot.pose = np.array((-6.0, 2.0, 0.0))
    bench = Bench(Localization, start_x_m=-6.0, start_y_m=2.0, start_heading_rad=0.0)
    stop_and_lose_odometry(bench, robot, 12)
    robot.odometry, robot.path_m = np.zeros(3), 0.0
    for _ in range(5):
        assert all(frames(bench, robot, 1))
        assert np.hypot(*robot.error(bench)[:2]) < 0.1


def test_velocity_counts_only_while_odometry_arrives() -> None:
    """At 2 m/s, points of a camera with 40 ms latency would be moved by 8 cm for ever."""
    robot = FakeRobot(seed=6)
    robot.pose, robot.latency_s = np.array((-6.0, 2.0, 0.0)), 0.04
    bench = Bench(Localization, start_x_m=-6.0, start_y_m=2.0, start_heading_rad=0.0)
    stop_and_lose_odometry(bench, robot, 40)
    assert np.hypot(*robot.error(bench)[:2]) < 0.04


@pytest.mark.parametrize("every", [2, 4])
def test_pose_is_honest_with_odometry_in_some_ticks_only(every: int) -> None:
    robot = FakeRobot(seed=5)
    bench = Bench(Localization, start_x_m=0.0, start_y_m=0.0, start_heading_rad=0.0)
    course = Course(robot)
    errors, nees = [], []
    for tick in range(200):
        course.step()
        robot.show(bench)
        if tick % every:
            bench.port("odometry").waiting.clear()
        bench.iterate()
        errors.append(robot.error(bench))
        nees.append(errors[-1] @ np.linalg.solve(np.array(bench.port("pose").sent[-1].covariance), errors[-1]))
    assert np.sqrt(np.square(errors).sum(axis=0))[:2].max() / math.sqrt(200) < 0.06
    assert np.mean(nees) < 5.0, "3 for an honest covariance"


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300, -1e300])
def test_impossible_values_are_ignored(value: float) -> None:
    robot = FakeRobot(seed=23)
    robot.pose = np.array((3.0, 2.0, 0.0))
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    for name in ("x_m", "y_m", "heading_rad", "vx_m_s"):
        bench.port("odometry").put(**{name: value})
        bench.port("imu").put(heading_rad=value, yaw_rate_rad_s=value)
        bench.port("line_points").put(x_m=[value] * 20, y_m=[value] * 20)
        bench.iterate()
    assert all(frames(bench, robot, 10))
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


def test_live_settings_count_from_the_next_frame() -> None:
    robot = FakeRobot(seed=25)
    robot.pose = np.array((3.0, 2.0, 0.0))
    bench = Bench(Localization)
    assert until_localized(bench, robot, 5.0) < math.inf
    bench.runner.configure({**bench.component.config.model_dump(), "good_score": 0.99})
    assert all(frames(bench, robot, 5)), "the pose is kept"
    robot.pose = np.array((-6.0, -2.0, 0.0))
    frames(bench, robot, 40)
    assert not any(frames(bench, robot, 40)), "no picture is that good"


def test_live_setting_keeps_the_pose_and_the_compass_offset() -> None:
    bench, robot = Bench(Localization), FakeRobot(5)
    robot.pose = np.array((-5.0, 2.0, 0.3))
    frames(bench, robot, 100)
    localizer = bench.component._localizer
    before = localizer.covariance.tolist(), localizer.compass_offset_rad
    bench.component.config = LocalizationConfig(points=80)
    bench.component.config_changed()
    localizer = bench.component._localizer
    assert (localizer.covariance.tolist(), localizer.compass_offset_rad) == before


def test_heading_stays_within_half_a_turn_while_searching() -> None:
    bench, robot = Bench(Localization), FakeRobot(6)
    robot.pose = np.array((-5.0, 2.0, 3.1))
    for _ in range(12):
        frames(bench, robot, 1)
        assert abs(bench.port("pose").sent[-1].heading_rad) <= math.pi


GLITCHES: dict[str, tuple[str, dict[str, Any]]] = {
    "gyro": ("imu", {"heading_rad": 0.5, "yaw_rate_rad_s": 40.0}),
    "wheels that turn a robot": ("odometry", {"heading_rad": 2.0}),
    "zeros in the place of points": ("line_points", {"x_m": [0.0] * 50, "y_m": [0.0] * 50}),
}


@pytest.mark.parametrize("glitch", GLITCHES)
def test_reading_that_cannot_be_moves_no_robot(glitch: str) -> None:
    """The robot has no compass while its wheels seem to turn it, so that no gyro tells better."""
    bench, robot = Bench(Localization), FakeRobot(seed=23)
    robot.pose = np.array((3.0, 2.0, 0.5))
    assert until_localized(bench, robot, 5.0) < math.inf
    port, reading = GLITCHES[glitch]
    for tick in range(20):
        robot.show(bench)
        if port == "odometry":
            bench.port("imu").waiting.clear()
        if tick == 5:
            bench.port(port).put(**reading)
        bench.iterate()
        assert bench.port("pose").sent[-1].localized
        assert np.abs(robot.error(bench)).max() < 0.1


def test_heading_of_wheels_may_wrap() -> None:
    robot = FakeRobot(seed=23)
    robot.pose = np.array((3.0, 2.0, 0.0))
    robot.odometry = np.array((0.0, 0.0, 3.0))
    bench = Bench(Localization, start_x_m=3.0, start_y_m=2.0, start_heading_rad=0.0)
    frames(bench, robot, 5)
    for _ in range(10):
        robot.drive(np.array((2.0, 0.0, 1.0)))
        x_m, y_m, heading_rad = robot.odometry.tolist()
        bench.port("odometry").put(x_m=x_m, y_m=y_m, heading_rad=math.remainder(heading_rad, math.tau), vx_m_s=2.0)
        bench.iterate()
    assert np.hypot(*robot.error(bench)[:2]) < 0.1, "0.2 m less in the tick in which the heading wraps"


@pytest.mark.parametrize(("realism", "scale_sd"), [("realistic", 0.03), ("harsh", 0.06)])
def test_robot_without_frames_claims_what_it_knows(realism: str, scale_sd: float) -> None:
    surprises = []
    for seed in range(8):
        robot = FakeRobot(seed)
        robot.scale = 1.0 + scale_sd * np.random.default_rng(seed + 100).standard_normal(2)
        bench = Bench(Localization, realism=realism, start_x_m=0.0, start_y_m=0.0, start_heading_rad=0.0)
        course = Course(robot)
        for tick in range(160):
            course.step()
            robot.show(bench)
            if tick >= 60 or tick % 2:
                bench.port("line_points").waiting.clear()
            bench.iterate()
            if tick >= 120:
                covariance = np.array(bench.port("pose").sent[-1].covariance)
                surprises.append(robot.error(bench) @ np.linalg.solve(covariance, robot.error(bench)))
    assert np.mean(surprises) < 4.0, "3 for an honest covariance"


def test_robot_without_a_gyro_claims_what_wheels_know() -> None:
    """Wheels of slightly different sizes turn a robot that drives ahead, in the same direction all the time."""
    sets = (
        "world/simulator.silent_imus=[cyan1]",
        "world/simulator.starts={cyan1: [1.0, 2.0, 0.5]}",
        "cyan1/localization.start_x_m=1.0",
        "cyan1/localization.start_y_m=2.0",
        "cyan1/localization.start_heading_rad=0.5",
    )
    surprises = np.concatenate([wander(seed, sets)[1] for seed in range(4)])
    assert len(surprises) == 4 * 400
    assert np.mean(surprises) < 3.5, "3 for an honest covariance"


def test_turn_by_wheels_without_frames_stays_wrong() -> None:
    made = PoseFilter(np.zeros(3), (0.01, 0.01, 0.01))
    for _ in range(20):
        made.predict(0.05, 0.0, 0.0, 0.05, turn_sd_rad=0.005)
    assert math.sqrt(made.covariance[2, 2]) == pytest.approx(0.1, rel=0.05)
    made.correct(np.zeros(3), np.diag((1e-4, 1e-4, 1e-4)))
    before = made.covariance[2, 2]
    made.predict(0.05, 0.0, 0.0, 0.05, turn_sd_rad=0.005)
    assert made.covariance[2, 2] - before < 1e-4, "the frame has made it good"


@pytest.mark.parametrize("variance", [-1.0, math.nan, math.inf, 1e9])
def test_wheels_that_state_no_error_have_none(variance: float) -> None:
    deviations = []
    for stated in (variance, 0.0):
        bench = Bench(Localization, start_x_m=3.0, start_y_m=2.0, start_heading_rad=0.0)
        for tick in range(5):
            covariance = [[0.0] * 3, [0.0] * 3, [0.0, 0.0, stated]]
            bench.port("odometry").put(x_m=0.05 * tick, vx_m_s=1.0, velocity_covariance=covariance)
            bench.iterate()
        deviations.append(bench.port("pose").sent[-1].covariance[2][2])
    assert deviations[0] == deviations[1]

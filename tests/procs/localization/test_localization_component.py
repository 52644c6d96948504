"""Self-localization on made-up white points: accuracy, honesty, recovery from kidnapping, determinism."""

import math
from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray

from fwk.testing import Bench
from procs.evaluation.system import settings_in
from procs.localization.global_search import GlobalSearch
from procs.localization.line_map import LineMap, line_map
from procs.localization.line_matching import LinePoints, match
from procs.localization.localization import Localization, LocalizationConfig
from procs.localization.pose_filter import PoseFilter
from procs.model.field import Field
from procs.model.frames import rotation, wrap

Floats = NDArray[np.float64]
FIELD = Field()
PERIOD_S = 0.05
REACH_M = 6.0


@lru_cache(maxsize=1)
def paint_m() -> Floats:
    """Points (n, 2) along the middles of all lines, 2 cm apart; made without the table under test."""
    parts = []
    for segment in FIELD.segments():
        start, end = np.array(segment.start), np.array(segment.end)
        parts.append(start + np.linspace(0, 1, int(np.hypot(*(end - start)) / 0.02))[:, None] * (end - start))
    for arc in FIELD.arcs():
        angles = np.linspace(arc.start_rad, arc.end_rad, int(arc.radius_m * (arc.end_rad - arc.start_rad) / 0.02))
        parts.append(np.array(arc.centre) + arc.radius_m * np.column_stack((np.cos(angles), np.sin(angles))))
    return np.concatenate(parts)


class FakeRobot:
    """A robot with true pose and noisy sensors: white points, wheels, gyro, drifting compass."""

    def __init__(self, seed: int, clutter: float = 0.1) -> None:
        self.rng = np.random.default_rng(seed)
        self.clutter = clutter
        self.pose = np.zeros(3)
        self.odometry = np.zeros(3)
        self.drift_rad = 0.03 * self.rng.standard_normal()
        self.scale = 1 + 0.03 * self.rng.standard_normal(2)
        self.velocity = np.zeros(3)
        self.measured = np.zeros(3)

    def place(self) -> None:
        """Somewhere on the field."""
        self.pose = self.rng.uniform((-10.5, -6.5, -math.pi), (10.5, 6.5, math.pi))

    def drive(self, velocity: Floats) -> None:
        """One frame at a velocity of the robot frame: m/s, m/s, rad/s."""
        self.velocity = velocity
        self.pose = self._moved(self.pose, velocity)
        measured = self.measured = velocity.copy()
        measured[:2] *= self.scale * (1 + 0.05 * self.rng.standard_normal(2))
        measured[2] *= 1 + 0.05 * self.rng.standard_normal()
        self.odometry = self._moved(self.odometry, measured)
        self.drift_rad += 0.03 * math.sqrt(PERIOD_S / 60) * self.rng.standard_normal()

    @staticmethod
    def _moved(pose: Floats, velocity: Floats) -> Floats:
        way_m = rotation(pose[2] + velocity[2] * PERIOD_S / 2) @ velocity[:2] * PERIOD_S
        return np.array((*(pose[:2] + way_m), pose[2] + velocity[2] * PERIOD_S))

    def white_points(self, count: int = 100) -> tuple[Floats, Floats]:
        """White points in the robot frame, from an omnidirectional picture that shakes; and clutter."""
        seen = (paint_m() - self.pose[:2]) @ rotation(self.pose[2])
        range_m = np.hypot(seen[:, 0], seen[:, 1])
        inside = np.flatnonzero((range_m < REACH_M) & (range_m > 0.4))
        chosen = inside[self.rng.choice(len(inside), min(count, len(inside)), replace=False)]
        seen, range_m = seen[chosen], range_m[chosen]
        ray = seen / range_m[:, None]
        along_m, across_m = 0.02 + 0.004 * range_m**2, 0.02 + 0.004 * range_m
        seen = seen + ray * (along_m * self.rng.standard_normal(len(seen)))[:, None]
        seen += ray[:, ::-1] * (-1, 1) * (across_m * self.rng.standard_normal(len(seen)))[:, None]
        shake_px = (0.2 + 0.3 * np.hypot(*self.velocity[:2])) * self.rng.standard_normal(2)
        seen += ray * (ray @ shake_px * (0.006 + 0.009 * range_m**2))[:, None]
        seen += ray[:, ::-1] * (-1, 1) * (ray[:, ::-1] * (-1, 1) @ shake_px * (0.006 + 0.006 * range_m))[:, None]
        false = self.rng.random(len(seen)) < self.clutter
        seen[false] = self.rng.uniform(-5, 5, (int(false.sum()), 2))
        return seen[:, 0], seen[:, 1]

    def show(self, bench: Bench) -> None:
        """Puts this frame's messages on the bench."""
        x_m, y_m = self.white_points()
        bench.port("line_points").put(x_m=x_m.tolist(), y_m=y_m.tolist())
        x, y, heading = self.odometry.tolist()
        vx_m_s, vy_m_s, _ = self.measured.tolist()
        bench.port("odometry").put(x_m=x, y_m=y, heading_rad=heading, vx_m_s=vx_m_s, vy_m_s=vy_m_s)
        compass = wrap(self.pose[2] + self.drift_rad + 0.03 * self.rng.standard_normal())
        bench.port("imu").put(
            heading_rad=compass, yaw_rate_rad_s=float(self.velocity[2] + 0.02 * self.rng.standard_normal())
        )

    def error(self, bench: Bench) -> Floats:
        """Newest published pose minus the true one; (3)."""
        sent = bench.port("pose").sent[-1]
        return np.array((sent.x_m - self.pose[0], sent.y_m - self.pose[1], wrap(sent.heading_rad - self.pose[2])))


def frames(bench: Bench, robot: FakeRobot, count: int) -> list[bool]:
    """Runs a standing robot; whether it was localized in each frame."""
    for _ in range(count):
        robot.drive(np.zeros(3))
        robot.show(bench)
        bench.iterate()
    return [sent.localized for sent in bench.port("pose").sent[-count:]]


def until_localized(bench: Bench, robot: FakeRobot, limit_s: float) -> float:
    """Seconds until the pose is published as known and is right."""
    for frame in range(round(limit_s / PERIOD_S)):
        if all(frames(bench, robot, 1)) and np.hypot(*robot.error(bench)[:2]) < 0.3:
            return (frame + 1) * PERIOD_S
    return math.inf


class Course:
    """Random driving within the field at up to 2.7 m/s, with accelerations that a robot can do."""

    def __init__(self, robot: FakeRobot) -> None:
        self.robot = robot
        self.target_m = np.zeros(2)
        self.omega_rad_s = 0.0

    def step(self) -> None:
        robot = self.robot
        if np.hypot(*(self.target_m - robot.pose[:2])) < 1.0:
            self.target_m = robot.rng.uniform((-10, -6), (10, 6))
            self.omega_rad_s = robot.rng.uniform(-3, 3)
        way_m = rotation(-robot.pose[2]) @ (self.target_m - robot.pose[:2])
        wanted = np.array((*(way_m / np.hypot(*way_m) * 2.7), self.omega_rad_s))
        most = np.array((3.0, 3.0, 10.0)) * PERIOD_S
        robot.drive(robot.velocity + np.clip(wanted - robot.velocity, -most, most))


def test_table_is_exact_near_a_straight_line_and_the_circle() -> None:
    x_m = np.array([-0.31, 0.17, 4.0])
    y_m = np.array([3.0, 4.0, FIELD.half_width_m - FIELD.line_width_m / 2 - 0.2])
    distance_m, _, _ = line_map(FIELD).look_up(x_m, y_m)
    assert np.abs(distance_m) == pytest.approx([0.31, 0.17, 0.2], abs=1e-9)
    on_circle = (FIELD.circle_diameter_m / 2 - FIELD.line_width_m / 2) * rotation(0.7)[:, 0]
    distance_m, _, _ = line_map(FIELD).look_up(on_circle[:1], on_circle[1:])
    assert np.abs(distance_m[0]) < 1e-3


def test_the_table_knows_every_painted_point() -> None:
    distance_m, _, _ = line_map(FIELD).look_up(paint_m()[:, 0], paint_m()[:, 1])
    assert np.abs(distance_m).max() < 0.05 / math.sqrt(2), "half a cell, where two lines meet"
    assert np.abs(distance_m).mean() < 0.002


def test_a_match_without_noise_finds_the_pose() -> None:
    robot = FakeRobot(seed=1, clutter=0.0)
    robot.pose = np.array((3.0, -2.0, 0.7))
    seen = (paint_m() - robot.pose[:2]) @ rotation(0.7)
    near = seen[np.hypot(seen[:, 0], seen[:, 1]) < 5.0][::7]
    found = match(line_map(FIELD), LinePoints(near[:, 0], near[:, 1]), np.add(robot.pose, (0.15, -0.1, 0.05))[None])
    assert found.poses[0] == pytest.approx(robot.pose, abs=2e-3)
    assert found.scores[0] > 0.999


def test_a_line_says_nothing_about_the_place_along_it() -> None:
    y_m = np.linspace(-0.7, 1.5, 50)
    found = match(line_map(FIELD), LinePoints(np.zeros(50), y_m), np.array([[0.1, 4.5, 0.0]]))
    information = found.information[0]
    assert information[1, 1] < 0.01 * information[0, 0]
    assert found.poses[0] == pytest.approx((0.0, 4.5, 0.0), abs=0.02)


def test_blockwise_table_equals_the_table_of_all_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    places_m = np.random.default_rng(1).uniform((-11.0, -8.0), (11.0, 8.0), (5000, 2))
    by_blocks = LineMap(FIELD).look_up(*places_m.T)
    monkeypatch.setattr("procs.localization.line_map._BLOCK_M", 100.0)  # one block, to which all lines are near
    assert np.array_equal(by_blocks, LineMap(FIELD).look_up(*places_m.T))


def test_the_search_finds_the_place_among_its_first_guesses() -> None:
    robot = FakeRobot(seed=3)
    search = GlobalSearch(line_map(FIELD), REACH_M)
    hits = 0
    for _ in range(20):
        robot.place()
        x_m, y_m = robot.white_points()
        found = search.best(LinePoints(x_m, y_m).thinned(40), np.array([robot.pose[2] + 0.03]), 4)
        hits += bool((np.hypot(*(found[:, :2] - robot.pose[:2]).T) < 0.5).any())
    assert hits >= 18


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


def test_the_compass_tells_the_halves_apart() -> None:
    for heading_rad in (0.3, 0.3 - math.pi):
        robot = FakeRobot(seed=11)
        robot.pose = np.array((5.0, 2.0, heading_rad))
        bench = Bench(Localization)
        assert until_localized(bench, robot, 5.0) < math.inf
        assert np.hypot(*robot.error(bench)[:2]) < 0.15


def test_pushed_robot_is_followed_without_a_new_search() -> None:
    robot = FakeRobot(seed=13)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench = Bench(Localization, start_x_m=2.0, start_y_m=1.0, start_heading_rad=0.5)
    frames(bench, robot, 20)
    robot.pose = np.add(robot.pose, (0.15, 0.1, 0.1))
    assert all(frames(bench, robot, 5))
    assert np.hypot(*robot.error(bench)[:2]) < 0.04


def test_a_compass_that_contradicts_the_pose_starts_a_search() -> None:
    robot = FakeRobot(seed=15)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench = Bench(Localization, start_x_m=-2.0, start_y_m=-1.0, start_heading_rad=0.5 - math.pi)
    assert until_localized(bench, robot, 5.0) < math.inf, "it began as the mirror image of the true pose"


def test_same_messages_give_the_same_poses() -> None:
    def run() -> list[bytes]:
        robot = FakeRobot(seed=17)
        robot.place()
        bench = Bench(Localization)
        frames(bench, robot, 60)
        return [sent.encode() for sent in bench.port("pose").sent]

    assert run() == run()


def test_a_part_of_a_start_pose_is_refused() -> None:
    with pytest.raises(ValueError, match="belong together"):
        Bench(Localization, start_x_m=1.0)


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


def test_odometry_that_begins_anew_moves_nobody() -> None:
    robot = FakeRobot(seed=21)
    robot.pose = np.array((3.0, 2.0, 0.0))
    robot.odometry = np.array((7.0, -3.0, 2.0))
    bench = Bench(Localization, start_x_m=3.0, start_y_m=2.0, start_heading_rad=0.0)
    frames(bench, robot, 10)
    robot.odometry = np.zeros(3)
    assert all(frames(bench, robot, 10))
    assert np.hypot(*robot.error(bench)[:2]) < 0.05


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300, -1e300])
def test_values_that_cannot_be_are_survived(value: float) -> None:
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


@pytest.mark.parametrize("parity", [0, 1])
def test_kidnapping_is_noticed_with_frames_of_every_second_tick(parity: int) -> None:
    """Cameras take turns: a robot may get its frames in even or in odd ticks only."""
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


def test_robot_without_compass_is_declared_lost() -> None:
    start = {"start_x_m": -5.0, "start_y_m": 2.0, "start_heading_rad": 0.3}
    bench, robot = Bench(Localization, **settings_in("soccer.yaml", "cyan1/localization") | start), FakeRobot(4)
    known: list[bool] = []
    for tick in range(200):
        robot.pose = np.array((-5.0, 2.0, 0.3) if tick < 60 else (4.0, -3.0, 0.3))
        robot.drive(np.zeros(3))
        robot.show(bench)
        bench.port("imu").waiting.clear()
        bench.iterate()
        known.append(bench.port("pose").sent[-1].localized)
    assert all(known[10:60])
    assert not known[-1]


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


def test_filter_does_not_depend_on_the_length_of_a_tick() -> None:
    deviations = []
    for ticks in (20, 100):
        pose_filter = PoseFilter(np.zeros(3), (0.01, 0.01, 0.01))
        for _ in range(ticks):
            pose_filter.predict(2.0 / ticks, 0.0, 0.5 / ticks, 1.0 / ticks)
        deviations.append(np.sqrt(np.diag(pose_filter.covariance)))
    assert deviations[0] == pytest.approx(deviations[1], rel=0.1)

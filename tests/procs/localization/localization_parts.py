"""A simulated robot with white points, wheels, gyro and compass, for tests of the localization."""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from fwk.testing import Bench, system_of
from lcmtypes.soccer import ground_truth_t, pose_t
from procs.model.field import Field
from procs.model.frames import rotation
from procs.model.geometry import wrap_rad

Floats = NDArray[np.float64]
FIELD = Field()
PERIOD_S = 0.05
REACH_M = 6.0


@lru_cache(maxsize=1)
def paint_m() -> Floats:
    """Returns points (n, 2) along the middles of all lines, 2 cm apart; computed without the table under test."""
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
        self.path_m = 0.0
        self.drift_rad = 0.03 * self.rng.standard_normal()
        self.scale = 1 + 0.03 * self.rng.standard_normal(2)
        self.velocity = np.zeros(3)
        self.latency_s = 0.0  # of the camera
        self.measured = np.zeros(3)

    def place(self) -> None:
        """Puts the robot at a random pose on the field."""
        self.pose = self.rng.uniform((-10.5, -6.5, -math.pi), (10.5, 6.5, math.pi))

    def drive(self, velocity: Floats) -> None:
        """Drives for a frame at a velocity in the robot frame: m/s, m/s, rad/s."""
        self.velocity = velocity
        self.pose = self._moved(self.pose, velocity)
        measured = self.measured = velocity.copy()
        measured[:2] *= self.scale * (1 + 0.05 * self.rng.standard_normal(2))
        measured[2] *= 1 + 0.05 * self.rng.standard_normal()
        self.odometry = self._moved(self.odometry, measured)
        self.path_m += float(np.hypot(*measured[:2])) * PERIOD_S
        self.drift_rad += 0.03 * math.sqrt(PERIOD_S / 60) * self.rng.standard_normal()

    @staticmethod
    def _moved(pose: Floats, velocity: Floats) -> Floats:
        way_m = rotation(pose[2] + velocity[2] * PERIOD_S / 2) @ velocity[:2] * PERIOD_S
        return np.array((*(pose[:2] + way_m), pose[2] + velocity[2] * PERIOD_S))

    def white_points(self, count: int = 100) -> tuple[Floats, Floats]:
        """Returns white points in the robot frame, from a shaking picture with clutter."""
        pose = self.pose - self.latency_s * self.velocity * (0, 0, 1)
        way_m = self.latency_s * self.velocity[:2]
        pose[:2] -= rotation(self.pose[2] - self.latency_s * self.velocity[2] / 2) @ way_m
        x_m, y_m = paint_m().T
        squares_m2 = (x_m - pose[0]) ** 2 + (y_m - pose[1]) ** 2
        inside = np.flatnonzero((squares_m2 < REACH_M**2) & (squares_m2 > 0.4**2))
        chosen = inside[self.rng.choice(len(inside), min(count, len(inside)), replace=False)]
        seen = (paint_m()[chosen] - pose[:2]) @ rotation(pose[2])
        range_m = np.hypot(seen[:, 0], seen[:, 1])
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
        capture_us = round(bench.time_us + (PERIOD_S - self.latency_s) * 1e6) if self.latency_s else 0
        bench.port("line_points").put(x_m=x_m.tolist(), y_m=y_m.tolist(), capture_us=max(0, capture_us))
        x, y, heading = self.odometry.tolist()
        vx_m_s, vy_m_s, _ = self.measured.tolist()
        way = {"x_m": x, "y_m": y, "heading_rad": heading, "path_length_m": self.path_m}
        bench.port("odometry").put(**way, vx_m_s=vx_m_s, vy_m_s=vy_m_s)
        compass = wrap_rad(self.pose[2] + self.drift_rad + 0.03 * self.rng.standard_normal())
        bench.port("imu").put(
            heading_rad=compass, yaw_rate_rad_s=float(self.velocity[2] + 0.02 * self.rng.standard_normal())
        )

    def error(self, bench: Bench) -> Floats:
        """Returns the newest published pose minus the true one; (3)."""
        sent = bench.port("pose").sent[-1]
        return np.array((sent.x_m - self.pose[0], sent.y_m - self.pose[1], wrap_rad(sent.heading_rad - self.pose[2])))


def wander(seed: int, sets: tuple[str, ...], ticks: int = 400) -> tuple[Floats, Floats]:
    """Returns the errors (n, 3) of a wandering robot's pose while it is localized, and how surprising (n) each is."""
    wanted = ("world/simulator", "world/referee", *(f"cyan1/{each}" for each in ("base", "percepts", "localization")))
    system = system_of(
        "kidnapped.yaml",
        (*wanted, "cyan1/wanderer").__contains__,
        seed,
        (*sets, "*/wanderer.carried_every_s=0"),
    )
    system.tick(ticks)
    errors, surprises = [], []
    for place, told in zip(system.sent["world/ground_truth"], system.sent["cyan1/pose"], strict=True):
        pose, true = pose_t.decode(told), ground_truth_t.decode(place).robots[0]
        if pose.localized:
            error = np.array((pose.x_m - true.x_m, pose.y_m - true.y_m, wrap_rad(pose.heading_rad - true.heading_rad)))
            errors.append(error)
            surprises.append(float(error @ np.linalg.solve(pose.covariance, error)))
    return np.array(errors), np.array(surprises)


def frames(bench: Bench, robot: FakeRobot, count: int) -> list[bool]:
    """Runs a standing robot; returns whether it was localized in each frame."""
    for _ in range(count):
        robot.drive(np.zeros(3))
        robot.show(bench)
        bench.iterate()
    return [sent.localized for sent in bench.port("pose").sent[-count:]]


def until_localized(bench: Bench, robot: FakeRobot, limit_s: float) -> float:
    """Returns the time until the pose is published as known and is right; infinity after the limit."""
    for frame in range(round(limit_s / PERIOD_S)):
        if all(frames(bench, robot, 1)) and np.hypot(*robot.error(bench)[:2]) < 0.3:
            return (frame + 1) * PERIOD_S
    return math.inf


class Course:
    """Random driving within the field at up to 2.7 m/s, with feasible accelerations."""

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

"""What the robot itself sees in a frame, in the world frame."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lcmtypes.robot import odometry_t
from lcmtypes.soccer import ball_percept_t, obstacle_percepts_t, pose_t
from procs.estimation.frames import Flags, Floats, covariance_to_world, rotation, to_world
from procs.estimation.team import Mate


@dataclass(frozen=True)
class Seen:
    """n things in the world frame: positions (n, 2) in m, covariances (n, 2, 2) in m² in their two parts."""

    positions_m: Floats
    by_sight_m2: Floats
    by_pose_m2: Floats
    radii_m: Floats
    """(n): of obstacles."""

    @property
    def covariances_m2(self) -> Floats:
        """(n, 2, 2) of a single sighting."""
        return self.by_sight_m2 + self.by_pose_m2

    def only(self, which: Flags) -> "Seen":
        """Some of them."""
        return Seen(self.positions_m[which], self.by_sight_m2[which], self.by_pose_m2[which], self.radii_m[which])

    def spread_m2(self, sight_correlation: float, pose_correlation: float) -> Floats:
        """Covariances (n, 2, 2) for a filter that takes every frame for new, though errors last several frames."""
        return self.by_sight_m2 * sight_correlation + self.by_pose_m2 * pose_correlation


_NOTHING = Seen(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros((0, 2, 2)), np.zeros(0))


class OwnView:
    """Own pose and velocity, and what is seen from there."""

    def __init__(self, pose: pose_t, odometry: odometry_t, known: bool) -> None:
        """`known` is false if the pose is an old one."""
        self.localized = pose.localized and known
        self.pose = np.array((pose.x_m, pose.y_m, pose.heading_rad))
        self._covariance = np.array(pose.covariance)
        self.velocity_m_s = rotation(pose.heading_rad) @ (odometry.vx_m_s, odometry.vy_m_s)
        self.omega_rad_s = odometry.omega_rad_s

    def ball(self, percept: ball_percept_t) -> Seen:
        """The ball; nothing if it is not visible or the robot does not know where it is."""
        if not (percept.visible and self.localized):
            return _NOTHING
        return self._seen([(percept.x_m, percept.y_m)], [percept.covariance_m2], [0.0])

    def obstacles(self, percepts: obstacle_percepts_t) -> Seen:
        """The obstacles; none if the robot does not know where it is."""
        if not (percepts.obstacles and self.localized):
            return _NOTHING
        seen = percepts.obstacles
        return self._seen(
            [(one.x_m, one.y_m) for one in seen],
            [one.covariance_m2 for one in seen],
            [one.radius_m for one in seen],
        )

    def as_mate(self, name: str, now_s: float) -> Mate:
        """The robot itself, as its mates know it."""
        return Mate(name, "", now_s, self.pose[:2], float(self.pose[2]), self.velocity_m_s, self.localized)

    def held_ball(self, mouth_m: float) -> Floats:
        """State (4) of a ball in the mouth: it moves and turns with the robot."""
        offset_m = rotation(float(self.pose[2])) @ (mouth_m, 0.0)
        turning_m_s = self.omega_rad_s * np.array((-offset_m[1], offset_m[0]))
        return np.concatenate((self.pose[:2] + offset_m, self.velocity_m_s + turning_m_s))

    def _seen(self, positions_m: ArrayLike, covariances_m2: ArrayLike, radii_m: ArrayLike) -> Seen:
        points_m = np.asarray(positions_m, dtype=np.float64)
        by_sight_m2, by_pose_m2 = covariance_to_world(
            self.pose, self._covariance, points_m, np.asarray(covariances_m2, dtype=np.float64)
        )
        return Seen(to_world(self.pose, points_m), by_sight_m2, by_pose_m2, np.asarray(radii_m, dtype=np.float64))

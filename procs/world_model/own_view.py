"""The robot's own pose and velocity, and what it sees from there, in the world frame."""

import numpy as np

from lcmtypes.robot import odometry_t
from lcmtypes.soccer import ball_percept_t, obstacle_percepts_t, pose_t
from procs.model.frames import Floats, covariance_to_world, plausible, rotation, to_world
from procs.world_model.seen import Seen
from procs.world_model.team import Mate


class OwnView:
    """A frame; a robot that does not know where it is sees nothing in the world frame."""

    def __init__(self, pose: pose_t, odometry: odometry_t, known: bool, shake_s_m: float) -> None:
        """`known` is false if the pose is an old one.

        At each m/s that the robot drives, its camera shakes by `shake_s_m` times the standing camera's deviation.
        """
        flat = [value for row in pose.covariance for value in row]
        sound = plausible(pose.x_m, pose.y_m, pose.heading_rad, *flat)
        self.localized = pose.localized and known and sound
        self.pose = np.array((pose.x_m, pose.y_m, pose.heading_rad)) if sound else np.zeros(3)
        self._covariance = np.array(pose.covariance)
        moves = plausible(odometry.vx_m_s, odometry.vy_m_s, odometry.omega_rad_s)
        velocity_m_s = (odometry.vx_m_s, odometry.vy_m_s) if moves else (0.0, 0.0)
        self.velocity_m_s = rotation(float(self.pose[2])) @ velocity_m_s
        self.omega_rad_s = odometry.omega_rad_s if moves else 0.0
        self._shake = 1.0 + (shake_s_m * float(np.hypot(*self.velocity_m_s))) ** 2

    def ball(self, percept: ball_percept_t) -> Seen:
        """The ball (0 or 1)."""
        if not (percept.visible and self.localized):
            return Seen.NOTHING
        return self._from_here(Seen.of([(percept.x_m, percept.y_m)], [percept.covariance_m2], [0.0]))

    def obstacles(self, percepts: obstacle_percepts_t) -> Seen:
        """The obstacles."""
        seen = percepts.obstacles
        if not (seen and self.localized):
            return Seen.NOTHING
        places_m = [(one.x_m, one.y_m) for one in seen]
        return self._from_here(Seen.of(places_m, [one.covariance_m2 for one in seen], [one.radius_m for one in seen]))

    def as_mate(self, name: str, now_s: float) -> Mate:
        """The robot itself, as its mates know it."""
        return Mate(name, "", now_s, self.pose[:2], float(self.pose[2]), self.velocity_m_s, self.localized)

    def held_ball(self, mouth_m: float) -> Floats:
        """State (4) of a ball in the mouth: it moves and turns with the robot."""
        offset_m = rotation(float(self.pose[2])) @ (mouth_m, 0.0)
        turning_m_s = self.omega_rad_s * np.array((-offset_m[1], offset_m[0]))
        return np.concatenate((self.pose[:2] + offset_m, self.velocity_m_s + turning_m_s))

    def _from_here(self, seen: Seen) -> Seen:
        shaken_m2 = seen.by_sight_m2 * self._shake
        by_sight_m2, by_pose_m2 = covariance_to_world(self.pose, self._covariance, seen.positions_m, shaken_m2)
        return Seen(to_world(self.pose, seen.positions_m), by_sight_m2, by_pose_m2, seen.radii_m)

"""The robot's own pose and velocity, and its percepts in the world frame."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from lcmtypes.robot import odometry_t
from lcmtypes.soccer import ball_candidate_t, ball_percept_t, obstacle_percepts_t, obstacle_t, pose_t
from procs.model.covariance import is_covariance
from procs.model.frames import Floats, rotation, to_world
from procs.model.geometry import plausible, wrap_rad
from procs.model.nearest import nearest
from procs.model.rays import left_of, rays
from procs.model.robot import FASTEST_M_S, FASTEST_RAD_S
from procs.world_model.seen import MOST_OBSTACLES, Seen
from procs.world_model.team import Mate, PlaceRow

_FASTEST = (FASTEST_M_S, FASTEST_M_S, FASTEST_RAD_S)  # a pose that changes faster was corrected
_MOST_BALLS = 20  # candidates of a frame that count besides the likeliest: more would take the time of the tick
_TRAIL_S = 0.5  # poses are kept for the age of the oldest sightings that count
_ROLLS_IN_M_S = 0.5  # a ball that rolls in more slowly counts as held


class _Past(NamedTuple):
    """A pose some time ago."""

    age_s: float
    pose: Floats
    """(3)."""
    rates: Floats
    """(3): its change in a second, in the tick that led to it."""

    def older(self, by_s: float) -> "_Past":
        """Returns the same pose, `by_s` older."""
        return _Past(self.age_s + by_s, self.pose, self.rates)


class Shaking(NamedTuple):
    """Growth of the camera's deviations for each m/s of the robot, as a share of those at a standstill."""

    ball_s_m: float
    robot_s_m: float


class OwnView:
    """Pose and velocity of a tick; a robot that does not know its place sees nothing in the world frame."""

    def __init__(
        self,
        pose: pose_t,
        odometry: odometry_t,
        known: bool,
        shaking: Shaking,
        before: "OwnView | None" = None,
        passed_s: float = 0.0,
    ) -> None:
        """Takes the newest messages.

        Args:
            pose: newest pose.
            odometry: newest odometry.
            known: False if the pose is an old one, or one where the robot cannot be.
            shaking: growth of the camera's deviations with the speed of the robot.
            before: the view `passed_s` ago.
            passed_s: see `before`.
        """
        sound = plausible(pose.x_m, pose.y_m, pose.heading_rad) and is_covariance(pose.covariance)
        self.localized = pose.localized and known and sound
        self.pose = np.array((pose.x_m, pose.y_m, pose.heading_rad)) if sound else np.zeros(3)
        self.covariance = np.array(pose.covariance) if sound else np.zeros((3, 3))
        moves = _is_possible((odometry.vx_m_s, odometry.vy_m_s, odometry.omega_rad_s))
        velocity_m_s = (odometry.vx_m_s, odometry.vy_m_s) if moves else (0.0, 0.0)
        self.velocity_m_s = rotation(float(self.pose[2])) @ velocity_m_s
        self.omega_rad_s = odometry.omega_rad_s if moves else 0.0
        rates: tuple[float, float, float] = (*self.velocity_m_s.tolist(), self.omega_rad_s)
        former: tuple[_Past, ...] = ()
        if before is not None and before.localized and self.localized and passed_s > 0.0:
            turned = _rates(before.pose, self.pose, passed_s)
            if _is_possible(turned):
                rates, self.omega_rad_s = turned, turned[2]
                former = tuple(past.older(passed_s) for past in before.trail if past.age_s + passed_s <= _TRAIL_S)
        self.trail: tuple[_Past, ...] = (_Past(0.0, self.pose, np.array(rates)), *former)
        """This pose and those before it, the newest first, back to one that was corrected."""
        speed_m_s = float(np.hypot(*self.velocity_m_s))
        self._ball_shake = (1.0 + shaking.ball_s_m * speed_m_s) ** 2  # factors of the covariances
        self._robot_shake = (1.0 + shaking.robot_s_m * speed_m_s) ** 2

    def ball(self, percept: ball_percept_t, age_s: float) -> Seen:
        """Returns the likeliest ball (0 or 1) of a percept captured `age_s` ago."""
        return self._candidate(percept, age_s) if percept.visible and self.localized else Seen.NOTHING

    def other_balls(self, percept: ball_percept_t, age_s: float) -> list[tuple[Seen, float]]:
        """Returns the less likely balls of a percept captured `age_s` ago, each (0 or 1) with its height in m."""
        others = percept.others[:_MOST_BALLS] if self.localized else []
        return [(self._candidate(other, age_s), other.z_m) for other in others]

    def _candidate(self, ball: ball_percept_t | ball_candidate_t, age_s: float) -> Seen:
        found = Seen.of([(ball.x_m, ball.y_m)], [ball.covariance_m2], [0.0])
        if ball.z_m > 0.0:  # the distance of a ball in the air follows from its size, which no shaking changes
            return self._from_here(found, _shaken_across(found, self._ball_shake), age_s)
        return self._from_here(found, found.by_sight_m2 * self._ball_shake, age_s)

    def obstacles(self, percepts: obstacle_percepts_t, age_s: float, team: int) -> Seen:
        """Returns the obstacles of percepts captured `age_s` ago, without robots that show the colour of a team.

        `team` is its number; 0 leaves out none.
        """
        return self._obstacles([one for one in percepts.obstacles if not team or one.team != team], age_s)

    def mates(
        self, percepts: obstacle_percepts_t, age_s: float, team: int, known: Sequence[PlaceRow], within_m: float
    ) -> Seen:
        """Returns the robots of percepts captured `age_s` ago that show the colour of a team and are not known yet.

        Args:
            percepts: the obstacles.
            age_s: time since their exposure.
            team: number of the team; 0: not known.
            known: robots of the team; robots seen near them are left out at little cost, and these are nearly all.
            within_m: largest distance that counts as near.
        """
        seen = [one for one in percepts.obstacles if one.team == team] if team else []
        if not (seen and self.localized):
            return Seen.NOTHING
        x_m, y_m, heading_rad = self.pose.tolist()
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        new = []
        for one in seen:
            at_m = (x_m + cos * one.x_m - sin * one.y_m, y_m + sin * one.x_m + cos * one.y_m)
            if all(math.dist(at_m, row[:2]) > within_m for row in known):
                new.append(one)
        return self._obstacles(new, age_s)

    def _obstacles(self, seen: Sequence[obstacle_t], age_s: float) -> Seen:
        if not (seen and self.localized):
            return Seen.NOTHING
        if len(seen) > MOST_OBSTACLES:
            seen = nearest(seen, MOST_OBSTACLES)
        places_m = [(one.x_m, one.y_m) for one in seen]
        found = Seen.of(places_m, [one.covariance_m2 for one in seen], [one.radius_m for one in seen])
        return self._from_here(found, found.by_sight_m2 * self._robot_shake, age_s)

    def as_mate(self, name: str, now_s: float) -> Mate:
        """Returns the robot itself, as its mates know it."""
        heading_rad = float(self.pose[2])
        return Mate(
            name, "", now_s, self.pose[:2], heading_rad, self.velocity_m_s, self.localized, self.covariance[:2, :2]
        )

    def held_ball(self, mouth_m: float) -> tuple[Floats, Floats]:
        """Returns the state (4) of a ball in the mouth, world frame, and its covariance (4, 4) by the own pose.

        The ball moves and turns with the robot; `mouth_m` is the distance from the robot's middle to that of the ball.
        """
        offset_m = rotation(float(self.pose[2])) @ (mouth_m, 0.0)
        turning_m_s = self.omega_rad_s * np.array((-offset_m[1], offset_m[0]))
        state = np.concatenate((self.pose[:2] + offset_m, self.velocity_m_s + turning_m_s))
        by_pose = np.array(((1.0, 0.0, -offset_m[1]), (0.0, 1.0, offset_m[0])))
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = by_pose @ self.covariance @ by_pose.T
        return state, covariance

    def rolls_in(self, ball: Floats, held: Floats) -> bool:
        """Returns whether a ball with the state (4) rolls towards the mouth and has not touched it yet.

        `held` is the state (4) of a held ball. The light barrier sees a ball that rolls in a moment before the mouth
        stops it.
        """
        ahead = rotation(float(self.pose[2])) @ (1.0, 0.0)
        gap_m, away_m_s = ahead @ (ball[:2] - held[:2]), ahead @ (ball[2:] - held[2:])
        return bool(gap_m > 0.0 and away_m_s < -_ROLLS_IN_M_S)

    def kicked_m_s(self, kick_speed_m_s: float, mouth_m: float) -> Floats:
        """Returns the velocity (2) of a ball that was just kicked, world frame."""
        heading_rad = float(self.pose[2])
        away = kick_speed_m_s * np.array((np.cos(heading_rad), np.sin(heading_rad)))
        return self.held_ball(mouth_m)[0][2:] + away

    def _at(self, age_s: float) -> Floats:
        """Returns the pose (3) at an exposure `age_s` ago."""
        past = next((each for each in reversed(self.trail) if each.age_s <= age_s), self.trail[0])
        return past.pose - (age_s - past.age_s) * past.rates

    def _from_here(self, seen: Seen, shaken_m2: Floats, age_s: float) -> Seen:
        """Transforms things seen `age_s` ago, with covariances (n, 2, 2), from the robot frame to the world frame."""
        pose = self._at(age_s)
        return Seen(*to_world(pose, self.covariance, seen.positions_m, shaken_m2), seen.radii_m)


def _shaken_across(seen: Seen, factor: float) -> Floats:
    """Returns the covariances (n, 2, 2) of the sight, with variances across the rays that are `factor` times larger."""
    _, ahead = rays(seen.positions_m)
    across = left_of(ahead)
    variances_m2 = np.einsum("ni,nij,nj->n", across, seen.by_sight_m2, across)[:, None, None]
    return np.asarray(seen.by_sight_m2 + (factor - 1.0) * variances_m2 * across[:, :, None] * across[:, None, :])


def _is_possible(rates: tuple[float, float, float]) -> bool:
    """Returns whether a robot can move along x and y, and turn, so fast (m/s, m/s, rad/s)."""
    return all(abs(rate) < fastest for rate, fastest in zip(rates, _FASTEST, strict=True))


def _rates(before: Floats, now: Floats, passed_s: float) -> tuple[float, float, float]:
    """Returns the rates of change of a pose: m/s, m/s, rad/s.

    They are better than the wheels' velocity: in a scrum, slipping wheels report up to 4 rad/s while the robot does
    not turn, whereas the pose follows the gyro.
    """
    (x_m, y_m, heading_rad), (before_x_m, before_y_m, before_rad) = now.tolist(), before.tolist()
    return (x_m - before_x_m) / passed_s, (y_m - before_y_m) / passed_s, wrap_rad(heading_rad - before_rad) / passed_s

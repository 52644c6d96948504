"""The true world a short time ago, for sensors with a latency."""

import math
from collections import deque

from lcmtypes.soccer import ground_truth_t, true_robot_t

_KEPT_US = 1_200_000  # longer than the longest latency
_SUDDEN_M_S = 4.0  # within a tick a body is faster than before and after it by this at most; else it was placed
_SUDDEN_RAD_S = 15.0  # the same of the turning of a robot
_KICK_M_S = 20.0  # of a ball that is kicked and bounces within a tick


class Past:
    """The last messages of the simulator; between two of them robots and ball move straight."""

    def __init__(self) -> None:
        self._kept: deque[ground_truth_t] = deque()

    def add(self, truth: ground_truth_t) -> None:
        """Takes the newest message."""
        self._kept.append(truth)
        oldest_us = truth.header.time_us - _KEPT_US
        while len(self._kept) > 1 and self._kept[1].header.time_us <= oldest_us:
            self._kept.popleft()

    def reaches(self, time_us: int) -> bool:
        """Returns whether the world at a time is known; before the first tick of a run it stands as in that tick."""
        oldest = self._kept[0].header
        return oldest.time_us <= time_us or oldest.tick <= 1

    def at(self, time_us: int) -> ground_truth_t:
        """Returns the world at a time: the oldest known one for times before.

        Raises:
            IndexError: nothing is known yet.
        """
        later = self._kept[-1]
        for earlier in reversed(self._kept):
            if earlier.header.time_us <= time_us:
                return _between(earlier, later, time_us)
            later = earlier
        return later


def _between(earlier: ground_truth_t, later: ground_truth_t, time_us: int) -> ground_truth_t:
    span_us = later.header.time_us - earlier.header.time_us
    if span_us <= 0 or time_us == earlier.header.time_us:
        return earlier
    return between(earlier, later, (time_us - earlier.header.time_us) / span_us, span_us / 1e6)


def between(earlier: ground_truth_t, later: ground_truth_t, share: float, span_s: float) -> ground_truth_t:
    """Returns the world after a share of the way from one message to another, which is `span_s` later."""
    made = ground_truth_t()
    made.header = earlier.header
    then_m = earlier.ball_x_m, earlier.ball_y_m, earlier.ball_z_m
    way_m = math.dist(then_m, (later.ball_x_m, later.ball_y_m, later.ball_z_m))
    before_m_s = math.hypot(earlier.ball_vx_m_s, earlier.ball_vy_m_s, earlier.ball_vz_m_s)
    after_m_s = math.hypot(later.ball_vx_m_s, later.ball_vy_m_s, later.ball_vz_m_s)
    jumped = not way_m <= max(_KICK_M_S, _fastest_m_s(before_m_s, after_m_s)) * span_s
    for name in ("ball_x_m", "ball_y_m", "ball_z_m", "ball_vx_m_s", "ball_vy_m_s", "ball_vz_m_s"):
        then, now = getattr(earlier, name), getattr(later, name)
        setattr(made, name, now if jumped else then + share * (now - then))
    known = {robot.name: robot for robot in earlier.robots}
    made.robots = [_robot(known.get(robot.name, robot), robot, share, span_s) for robot in later.robots]
    return made


def _fastest_m_s(before_m_s: float, after_m_s: float) -> float:
    """Returns the highest mean speed between two messages with these speeds, of what was not placed.

    What was placed is seen at either place, not between them.
    """
    return max(before_m_s, after_m_s) + _SUDDEN_M_S


def _robot(earlier: true_robot_t, later: true_robot_t, share: float, span_s: float) -> true_robot_t:
    way_m = math.dist((earlier.x_m, earlier.y_m), (later.x_m, later.y_m))
    turn_rad = later.heading_rad - earlier.heading_rad
    before_m_s, after_m_s = math.hypot(earlier.vx_m_s, earlier.vy_m_s), math.hypot(later.vx_m_s, later.vy_m_s)
    turn_rad = math.remainder(turn_rad, math.tau) if math.isfinite(turn_rad) else math.inf
    fastest_rad_s = max(abs(earlier.omega_rad_s), abs(later.omega_rad_s)) + _SUDDEN_RAD_S
    if not (way_m <= _fastest_m_s(before_m_s, after_m_s) * span_s and abs(turn_rad) <= fastest_rad_s * span_s):
        return later
    made = true_robot_t()
    made.name, made.team, made.number = later.name, later.team, later.number
    rest = 1.0 - share
    made.x_m, made.y_m = rest * earlier.x_m + share * later.x_m, rest * earlier.y_m + share * later.y_m
    made.vx_m_s = rest * earlier.vx_m_s + share * later.vx_m_s
    made.vy_m_s = rest * earlier.vy_m_s + share * later.vy_m_s
    made.omega_rad_s = rest * earlier.omega_rad_s + share * later.omega_rad_s
    made.heading_rad = math.remainder(earlier.heading_rad + share * turn_rad, math.tau)
    return made

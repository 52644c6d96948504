"""Contacts of the ball with robots: it keeps its motion while no robot is within reach, and cannot pass through one."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from procs.model.normal import normal_cdf
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import NO_CONTACT, Contact
from procs.world_model.flight import Flight

_HULL_M = 0.03  # by how much the touch distance beside the mouth exceeds the one in the mouth
_HULL_SD_M = 0.03  # deviation of the distance at which a robot touches the ball: its mouth is flat, its back round
_MOST_M = 0.2  # largest deviation of the ball's place that counts; a less certain place is treated like this
_FLEES_M_S = 0.5  # a ball that surely leaves a robot faster than this was kicked, and is not touched again
_NEAR_M = 2.5  # robots further from the ball cannot touch it, not even if it was kicked in the last ticks
_RAMS_M_S = 2.0  # a robot handles a ball that approaches more slowly
_DENT_M = 0.08  # a ball that would be this much inside the touch distance cannot have run on
_SURELY_OVER = 1e-3  # probability of being low below which a ball passes over robots
_BOUNCE = 0.2  # share of the speed towards a robot with which a ball leaves it, on average over mouths and hulls

RobotRow = tuple[float, float, float, float, float]
"""Position x, y (m), velocity vx, vy (m/s), and variance of the position along an axis (m²)."""


@dataclass(frozen=True)
class Robots:
    """Robots near the ball at the end of a tick."""

    rows: tuple[RobotRow, ...]
    touch_m: float
    """Distance between the middles of robot and ball when they touch."""
    height_m: float
    """Height of the robots; a ball that flies higher passes over them."""

    @classmethod
    def near(cls, ball: BallFilter, robots: Iterable[RobotRow], touch_m: float, height_m: float) -> "Robots":
        """Returns those of the `robots` that may touch the ball."""
        x_m, y_m, *_ = ball.likeliest
        near = (row for row in robots if math.hypot(row[0] - x_m, row[1] - y_m) < _NEAR_M)
        return cls(tuple(near), touch_m, height_m)

    def contact(self, ball: BallFilter, duration_s: float, before_s: float, flight: Flight | None = None) -> Contact:
        """Returns the robots' effect on the ball in a step that begins `before_s` before the end of the tick.

        The height of a ball in the air counts at the moment when it reaches a robot, because it rises or falls.
        """
        if not self.rows or (self._flies_over(flight, 0.0) and self._flies_over(flight, duration_s)):
            return NO_CONTACT
        x_m, y_m, vx_m_s, vy_m_s, place_m2, speed_m2_s2 = ball.likeliest
        ball_m2, deviation_m_s = min(_MOST_M**2, place_m2), math.sqrt(speed_m2_s2)
        probability, hit = 0.0, NO_CONTACT
        for robot_x_m, robot_y_m, robot_vx_m_s, robot_vy_m_s, robot_m2 in self.rows:
            away = x_m - robot_x_m + robot_vx_m_s * before_s, y_m - robot_y_m + robot_vy_m_s * before_s
            past = vx_m_s - robot_vx_m_s, vy_m_s - robot_vy_m_s
            way_m = max(math.hypot(*away), 1e-6)
            closing_m_s = -(away[0] * past[0] + away[1] * past[1]) / way_m
            if -closing_m_s - 2 * deviation_m_s >= _FLEES_M_S:
                continue
            spread_m = math.sqrt(ball_m2 + robot_m2 + _HULL_SD_M**2)
            gap_m = way_m - self.touch_m - _HULL_M
            reaches_s = min(max(0.0, gap_m), duration_s * closing_m_s) / closing_m_s if closing_m_s > 0.0 else 0.0
            reaches = normal_cdf((duration_s * max(closing_m_s, 0.0) - gap_m) / spread_m)
            probability = max(probability, reaches * self._is_low(flight, reaches_s))
            if closing_m_s > _RAMS_M_S:
                found = self._hit(away, past, closing_m_s, duration_s, spread_m, flies=flight is not None)
                hit = max(hit, found._replace(hit=found.hit * self._is_low(flight, found.after_s)))
        return hit._replace(probability=probability)

    def _is_low(self, flight: Flight | None, after_s: float) -> float:
        """Returns the probability that a ball is not above the robots `after_s` after the beginning of the step."""
        return 1.0 if flight is None else flight.probably_below(self.height_m, after_s)

    def _flies_over(self, flight: Flight | None, after_s: float) -> bool:
        return self._is_low(flight, after_s) < _SURELY_OVER

    def _hit(
        self,
        away: tuple[float, float],
        past: tuple[float, float],
        closing_m_s: float,
        duration_s: float,
        spread_m: float,
        flies: bool,
    ) -> Contact:
        """Returns the contact of a robot with a ball that approaches it.

        A ball on the ground was hit if it would otherwise be inside the robot after the step. A ball in the air may
        rise above the robot meanwhile, so its hit counts in the step in which its way first touches the robot.

        Args:
            away: vector from the robot to the ball, m.
            past: velocity of the ball as the robot sees it, m/s.
            closing_m_s: part of that velocity towards the robot.
            duration_s: the step.
            spread_m: deviation of the distance between robot and ball.
            flies: the ball is in the air.
        """
        way_m, speed_m_s = math.hypot(*away), math.hypot(*past)
        ahead_m = way_m * closing_m_s / speed_m_s  # on the ball's way, to the place that is nearest to the robot
        aside_m2 = max(0.0, way_m * way_m - ahead_m * ahead_m)
        driven_m = min(ahead_m, duration_s * speed_m_s)
        touches_m = ahead_m - math.sqrt(max(0.0, self.touch_m**2 - aside_m2))
        if flies:
            inside_m = self.touch_m - math.sqrt(aside_m2) if 0.0 < touches_m <= driven_m else -math.inf
        else:
            inside_m = self.touch_m - _DENT_M - math.sqrt(aside_m2 + (ahead_m - driven_m) ** 2)
        after_s = min(max(0.0, touches_m), driven_m) / speed_m_s
        normal_x_m, normal_y_m = away[0] + past[0] * after_s, away[1] + past[1] * after_s
        towards_m2_s = max(0.0, -(past[0] * normal_x_m + past[1] * normal_y_m))
        turn_1_s = (1.0 + _BOUNCE) * towards_m2_s / max(normal_x_m**2 + normal_y_m**2, 1e-12)
        probability = min(1.0, closing_m_s - _RAMS_M_S) * normal_cdf(inside_m / spread_m)
        return Contact(probability, 0.0, turn_1_s * normal_x_m, turn_1_s * normal_y_m, after_s)

"""Holding: the ball must roll. A robot may stop it for 1 s or pull it back for 0.30 m, then not for 4 s (2016)."""

import math
from collections.abc import Mapping

from procs.model.field import Point
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason

_STILL_M_S = 0.1  # a slower ball does not roll
_BACK_M_S = 0.05  # a ball that comes faster towards its carrier is pulled back


class Holding:
    """Counts how long and how far the carrier has held the ball."""

    def __init__(self) -> None:
        self._robot = ""
        self._held_s = self._pulled_m = self._free_s = 0.0
        self._before: Point | None = None
        self._robots: Mapping[str, Point] = {}

    def watch(self, scene: Scene) -> Foul | None:
        """Returns the foul of a robot that has held the ball for too long or too far."""
        ball, before, robot = scene.sight.ball, self._before, scene.carrier.robot
        middle = scene.sight.robots.get(robot)
        was = self._robots.get(robot, middle)
        self._before, self._robots = ball, scene.sight.robots
        if robot and robot != self._robot:
            self._robot, self._held_s, self._pulled_m = robot, 0.0, 0.0
        if not robot:
            self._rolls(scene)
        if before is None or middle is None or was is None or scene.duration_s <= 0.0:
            return None
        moved_m = math.dist(before, ball)
        back_m = min(
            _backwards_m(middle, ball, Point(ball.x_m - before.x_m, ball.y_m - before.y_m)),
            _backwards_m(middle, ball, Point(middle.x_m - was.x_m, middle.y_m - was.y_m)),
        )
        pulls = back_m > _BACK_M_S * scene.duration_s
        if not pulls and moved_m > _STILL_M_S * scene.duration_s:
            self._rolls(scene)
            return None
        self._free_s = 0.0
        self._held_s += scene.duration_s
        self._pulled_m += back_m if pulls else 0.0
        if self._held_s <= scene.rules.holding_s and self._pulled_m <= scene.rules.holding_m:
            return None
        self._held_s = self._pulled_m = 0.0
        return Foul(robot, Reason.HOLDING, ball)

    def _rolls(self, scene: Scene) -> None:
        self._free_s += scene.duration_s
        if self._free_s >= scene.rules.holding_pause_s:
            self._held_s = self._pulled_m = 0.0


def _backwards_m(middle: Point, ball: Point, moved: Point) -> float:
    """Returns how far a motion leads from the ball towards the middle of its carrier.

    Ball and robot have to move so: a ball that runs into a standing robot is not pulled.
    """
    away_m = math.dist(middle, ball) or 1.0
    return ((middle.x_m - ball.x_m) * moved.x_m + (middle.y_m - ball.y_m) * moved.y_m) / away_m

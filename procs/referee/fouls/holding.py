"""Holding: the ball must roll. A robot may stop it for 1 s or pull it back for 0.30 m, then not for 4 s (2016)."""

import math
from collections.abc import Mapping

from procs.model.field import Point
from procs.model.geometry import between
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason


class Holding:
    """Counts how long and how far the carrier has held the ball."""

    def __init__(self) -> None:
        self._robot = ""
        self._held_s = self._pulled_m = self._free_s = 0.0
        self._before: Point | None = None
        self._robots: Mapping[str, Point] = {}

    def watch(self, scene: Scene) -> Foul | None:
        """Returns the foul of a robot that has held the ball for too long or too far."""
        ball, before, robot, rules = scene.sight.ball, self._before, scene.carrier.robot, scene.rules
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
        axis = between(before, ball, 0.5), between(was, middle, 0.5)
        back_m = min(_way_along_m(axis, before, ball), _way_along_m(axis, was, middle))
        pulls = back_m > rules.back_m_s * scene.duration_s
        if not pulls and moved_m > rules.still_m_s * scene.duration_s:
            self._rolls(scene)
            return None
        self._free_s = 0.0
        self._held_s += scene.duration_s
        self._pulled_m += back_m if pulls else 0.0
        if self._held_s <= rules.holding_s and self._pulled_m <= rules.holding_m:
            return None
        self._held_s = self._pulled_m = 0.0
        return Foul(robot, Reason.HOLDING, ball)

    def _rolls(self, scene: Scene) -> None:
        self._free_s += scene.duration_s
        if self._free_s >= scene.rules.holding_pause_s:
            self._held_s = self._pulled_m = 0.0


def _way_along_m(axis: tuple[Point, Point], before: Point, now: Point) -> float:
    """Returns how far a motion leads along the axis from the ball to the middle of its carrier, half-way of the tick.

    Ball and robot have to move so: a ball that runs into a standing robot is not pulled.
    """
    ball, middle = axis
    length_m = math.dist(ball, middle) or 1.0
    x_m, y_m = middle.x_m - ball.x_m, middle.y_m - ball.y_m
    return (x_m * (now.x_m - before.x_m) + y_m * (now.y_m - before.y_m)) / length_m

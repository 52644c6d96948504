"""Joins the obstacles of the omnidirectional camera with those of the stereo pair."""

import math

import numpy as np
from pydantic import Field

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t
from procs.model.algebra import Floats
from procs.model.covariance import is_covariance, is_positive
from procs.model.nearest import nearest
from procs.model.robot import ROBOT, RobotModel
from procs.model.units import US_PER_S

_SAME = 0.8  # as a share of a robot's width; the middles of two robots are further apart
_APART = 50  # so many messages of the pair in a row that are not joined are reported
_MOST = 100  # most obstacles of a detector that count; a field has ten robots


class ObstacleFusionConfig(Config):
    """Settings of the fusion."""

    robot: RobotModel = ROBOT
    """Geometry of the other robots."""
    same_m: float | None = Field(default=None, gt=0.0, le=2.0)
    """Obstacles nearer to each other than this are one; null: 0.8 of the width of a robot."""
    apart_s: float = Field(default=0.06, ge=0.0, le=1.0)
    """Percepts whose exposures are further apart are not joined."""
    alone_s: float = Field(default=0.3, gt=0.0, le=10.0)
    """Silence of the omnidirectional camera after which the obstacles of the pair are published alone."""


class ObstacleFusion(Component):
    """Publishes the obstacles of both cameras, each once, when there are new ones of the omnidirectional camera.

    While that camera is silent, new obstacles of the pair are published as they are.
    """

    stage = "sensor_process"
    obstacle_percepts: Reads[obstacle_percepts_t]
    stereo_obstacles: Reads[obstacle_percepts_t]
    fused_obstacles: Writes[obstacle_percepts_t]
    config: ObstacleFusionConfig
    clock: Clock
    log: Logger

    def init(self) -> None:
        self._published = 0  # number of the newest message of the pair whose obstacles were published
        self._apart = 0  # messages of the pair since then that could not be joined ...
        self._offered = 0  # ... and the number of the newest of them

    def loop(self) -> None:
        if not self.obstacle_percepts.refreshed:
            if self.stereo_obstacles.refreshed and self._is_alone():
                alone = self.stereo_obstacles.value
                self._published = self.stereo_obstacles.header.sequence
                self._publish(_captured_us(self.stereo_obstacles), joined([], alone.obstacles, self._same_m))
            return
        around, ahead = self.obstacle_percepts.value, self.stereo_obstacles.value
        number = self.stereo_obstacles.header.sequence
        captured_us = _captured_us(self.obstacle_percepts)
        older_s = (captured_us - _captured_us(self.stereo_obstacles)) / US_PER_S
        at_once = abs(captured_us - _captured_us(self.stereo_obstacles)) <= self.config.apart_s * US_PER_S
        together = self.stereo_obstacles.has_value and number != self._published and at_once
        if together:
            self._published, self._apart = number, 0
        elif self.stereo_obstacles.has_value and number not in (self._published, self._offered):
            self._offered = number
            self._report_apart(older_s)
        found = joined(around.obstacles, ahead.obstacles if together else [], self._same_m)
        self._publish(captured_us, found)

    def _report_apart(self, older_s: float) -> None:
        """Counts a message of the pair that is not joined; reports once that none is, with its age."""
        self._apart += 1
        if self._apart == _APART:
            age = f"{abs(older_s):.3f} s {'older' if older_s > 0 else 'newer'}"
            self.log.warning(
                f"no obstacles of the stereo pair are joined: their exposures are {age} than those of the "
                f"omnidirectional camera; apart_s is {self.config.apart_s:g} s"
            )

    @property
    def _same_m(self) -> float:
        return self.config.same_m or _SAME * 2 * self.config.robot.radius_m

    def _is_alone(self) -> bool:
        """Returns whether the omnidirectional camera is silent."""
        silent_s = self.clock.since_s(self.obstacle_percepts.header.time_us)
        return not self.obstacle_percepts.has_value or silent_s > self.config.alone_s

    def _publish(self, capture_us: int, obstacles: list[obstacle_t]) -> None:
        percepts = self.fused_obstacles.value = obstacle_percepts_t()
        percepts.capture_us, percepts.obstacles = capture_us, obstacles
        self.fused_obstacles.write()


def _captured_us(percepts: Reads[obstacle_percepts_t]) -> int:
    """Returns the time of the newest obstacles' exposure; if the message states none, the time of the message."""
    return percepts.value.capture_us or percepts.header.time_us


def joined(around: list[obstacle_t], ahead: list[obstacle_t], same_m: float) -> list[obstacle_t]:
    """Returns the obstacles of two detectors, robot frame; two at one place become their weighted mean.

    Weights are the inverse covariances. The pair with the smallest distance is joined first. Obstacles without a
    plausible place are left out; of each detector only the 100 nearest to the robot count.
    """
    ours, theirs = nearest(around, _MOST), nearest(ahead, _MOST)
    distances = sorted(
        (math.dist((one.x_m, one.y_m), (other.x_m, other.y_m)), i, j)
        for i, one in enumerate(ours)
        for j, other in enumerate(theirs)
    )
    partners: dict[int, int] = {}
    for distance_m, i, j in distances:
        if distance_m <= same_m and i not in partners and j not in partners.values():
            partners[i] = j
    made = [_mean(one, theirs[partners[i]]) if i in partners else one for i, one in enumerate(ours)]
    return [*made, *(other for j, other in enumerate(theirs) if j not in partners.values())]


def _mean(one: obstacle_t, other: obstacle_t) -> obstacle_t:
    """Returns the weighted mean; if only one covariance can be used, the obstacle that has it."""
    first, second = _covariance(one), _covariance(other)
    if first is None or second is None:
        return other if first is None else one
    share = first @ np.linalg.inv(first + second)
    made = obstacle_t()
    made.team = one.team or other.team
    way_m = share @ np.array((other.x_m - one.x_m, other.y_m - one.y_m))
    made.x_m, made.y_m = one.x_m + float(way_m[0]), one.y_m + float(way_m[1])
    made.radius_m = one.radius_m
    made.covariance_m2 = (first - share @ first).tolist()
    return made


def _covariance(obstacle: obstacle_t) -> Floats | None:
    """Returns the covariance (2, 2) in m²; None if the message states an impossible one."""
    stated_m2 = obstacle.covariance_m2
    return np.array(stated_m2) if is_covariance(stated_m2) and is_positive(stated_m2) else None

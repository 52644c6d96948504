"""Joins the obstacles of the omnidirectional camera with those of the stereo pair."""

import math

import numpy as np
from pydantic import Field

from fwk import Clock, Component, Config, Reads, Writes
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t
from procs.model.algebra import Floats
from procs.model.covariance import is_covariance
from procs.model.units import US_PER_S


class ObstacleFusionConfig(Config):
    """Settings of the fusion."""

    same_m: float = Field(default=0.4, gt=0.0)
    """Obstacles nearer to each other than that are one; robots are wider."""
    apart_s: float = Field(default=0.06, ge=0.0)
    """Percepts that were captured further apart are not joined."""


class ObstacleFusion(Component):
    """Publishes the obstacles of both, each once, when there are new ones of the omnidirectional camera."""

    stage = "sensor_process"
    obstacle_percepts: Reads[obstacle_percepts_t]
    stereo_obstacles: Reads[obstacle_percepts_t]
    fused_obstacles: Writes[obstacle_percepts_t]
    config: ObstacleFusionConfig
    clock: Clock

    def loop(self) -> None:
        if not self.obstacle_percepts.refreshed:
            return
        around, ahead = self.obstacle_percepts.value, self.stereo_obstacles.value
        together = self.stereo_obstacles.has_value and (
            abs(ahead.capture_us - around.capture_us) <= self.config.apart_s * US_PER_S
        )
        percepts = self.fused_obstacles.value = obstacle_percepts_t()
        percepts.capture_us = around.capture_us
        percepts.obstacles = joined(around.obstacles, ahead.obstacles if together else [], self.config.same_m)
        self.fused_obstacles.write()


def joined(around: list[obstacle_t], ahead: list[obstacle_t], same_m: float) -> list[obstacle_t]:
    """Returns the obstacles of two detectors; two of one place become one, weighted by their inverse covariances."""
    left = list(ahead)
    made = []
    for one in around:
        distances_m = [math.dist((one.x_m, one.y_m), (other.x_m, other.y_m)) for other in left]
        nearest = min(range(len(left)), key=distances_m.__getitem__, default=-1)
        near = nearest >= 0 and distances_m[nearest] <= same_m
        made.append(_mean(one, left.pop(nearest)) if near else one)
    return [*made, *left]


def _mean(one: obstacle_t, other: obstacle_t) -> obstacle_t:
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
    """Returns the covariance (2, 2) in m²; None for one that cannot be."""
    (xx, xy), (yx, yy) = obstacle.covariance_m2
    invertible = is_covariance(obstacle.covariance_m2) and xx > 0 and xx * yy > xy * yx
    return np.array(((xx, xy), (yx, yy))) if invertible else None

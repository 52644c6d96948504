"""Self-localization by 200 particles, in the place of the component `localization` or beside it."""

import numpy as np
from pydantic import Field as Setting

from fwk import Component, Config, Reads, Writes
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import line_points_t, pose_t
from procs.evaluation.particles import Particles
from procs.localization.line_map import line_map
from procs.localization.line_matching import LinePoints
from procs.model.field import Field, MatchField
from procs.model.frames import rotation
from procs.model.geometry import plausible, wrap_rad

_REACH_M = 7.0
_POINTS = 60


class ParticleLocalizationConfig(Config):
    """Settings of the particles."""

    field: MatchField = Setting(Field(), frozen=True)
    """Measures of the field."""


class ParticleLocalization(Component):
    """Publishes the mean of the particles; `localized` says that most of them are together."""

    stage = "sensor_process"

    line_points: Reads[line_points_t]
    odometry: Reads[odometry_t]
    imu: Reads[imu_t]
    pose: Writes[pose_t]
    config: ParticleLocalizationConfig
    rng: np.random.Generator

    @classmethod
    def preload(cls, config: ParticleLocalizationConfig) -> None:
        """Computes the table of the field's lines, which is the same for all robots."""
        line_map(config.field)

    def init(self) -> None:
        self._particles = Particles(line_map(self.config.field), self.rng)
        self._last: odometry_t | None = None

    def loop(self) -> None:
        self._move()
        if self.line_points.refreshed:
            seen = self.line_points.value
            points = LinePoints.chosen(np.array(seen.x_m), np.array(seen.y_m), _REACH_M, _POINTS)
            if len(points):
                self._particles.see(points.x_m, points.y_m, self._compass_rad())
        mean, covariance, together = self._particles.estimate()
        pose = self.pose.value
        pose.x_m, pose.y_m = mean[:2].tolist()
        pose.heading_rad = wrap_rad(float(mean[2]))
        pose.covariance = covariance.tolist()
        pose.localized = together
        self.pose.write()

    def _compass_rad(self) -> float | None:
        imu = self.imu.value
        return imu.heading_rad if self.imu.refreshed and plausible(imu.heading_rad) else None

    def _move(self) -> None:
        now = self.odometry.value
        if self.odometry.refreshed and plausible(now.x_m, now.y_m, now.heading_rad):
            before, self._last = self._last or now, now
            turn_rad = wrap_rad(now.heading_rad - before.heading_rad)
            ahead_m = rotation(-before.heading_rad - turn_rad / 2) @ (now.x_m - before.x_m, now.y_m - before.y_m)
            self._particles.move(float(ahead_m[0]), float(ahead_m[1]), turn_rad)

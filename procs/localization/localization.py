"""Self-localization: matches white points with the field's lines, and follows with odometry."""

import numpy as np
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import line_points_t, pose_t
from procs.localization.global_search import global_search
from procs.localization.line_map import line_map
from procs.localization.self_localizer import LocalizerSettings, Motion, SelfLocalizer
from procs.model.algebra import product
from procs.model.expected_errors import EXPECTED
from procs.model.field import Field
from procs.model.frames import Floats, rotation, wrap
from procs.model.geometry import plausible
from procs.model.realism import Realism

_FASTEST_M_S = 8.0  # no robot drives faster
_STALE_S = 0.5  # points captured before are taken as they are
_NO_POINTS = line_points_t()


class LocalizationConfig(Config):
    """Settings of the self-localization."""

    field: Field = Field()
    """Measures of the field."""
    start_x_m: float | None = Setting(None, frozen=True)
    """Start of the robot if it is known, world frame; needs the other two."""
    start_y_m: float | None = Setting(None, frozen=True)
    """See start_x_m."""
    start_heading_rad: float | None = Setting(None, frozen=True)
    """See start_x_m."""
    realism: Realism = "realistic"
    """Errors of the camera on which the pose's covariance counts: none, friendly, realistic or harsh."""
    reach_m: float = Setting(default=7.0, gt=0.5, le=12.0)
    """White points further away are not used."""
    points: int = Setting(default=100, ge=10)
    """Most white points of a frame that are used."""
    search_period_s: float = Setting(default=0.5, gt=0.0)
    """From one search of the whole field to the next while the pose is known."""
    lost_score: float = Setting(default=0.4, gt=0.0, lt=1.0)
    """The pose is given up when the points fit worse than this for some frames; 1 is a perfect fit."""
    good_score: float = Setting(default=0.5, gt=0.0, lt=1.0)
    """A place is believed only if the points fit at least that well."""


class Localization(Component):
    """Publishes the pose in each frame; `localized` is false while the place on the field is still searched."""

    stage = "sensor_process"

    line_points: Reads[line_points_t]
    odometry: Reads[odometry_t]
    imu: Reads[imu_t]
    pose: Writes[pose_t]
    config: LocalizationConfig
    clock: Clock
    log: Logger

    @classmethod
    def preload(cls, config: LocalizationConfig) -> None:
        """Computes the tables of the field's lines, which are the same for all robots."""
        global_search(line_map(config.field), config.reach_m)

    def init(self) -> None:
        """Makes the table of the field's lines.

        Raises:
            ValueError: only a part of the start pose is given.
        """
        config = self.config
        start = (config.start_x_m, config.start_y_m, config.start_heading_rad)
        given = [value for value in start if value is not None]
        if given and len(given) < 3:
            raise ValueError(
                f"{self.name}: start_x_m, start_y_m and start_heading_rad belong together; give all three or none"
            )
        self._last: odometry_t | None = None
        self._yaw_rate_rad_s = 0.0
        self._turning_rad_s = 0.0  # mean since the last frame
        self._last_us = 0
        self._localizer = SelfLocalizer(line_map(config.field), self._settings(), np.array(given) if given else None)
        self._updated_us = -1

    def loop(self) -> None:
        knew = self._localizer.localized
        points = self.line_points.value if self.line_points.refreshed else _NO_POINTS
        passed_s = self.clock.period_s if self._updated_us < 0 else self.clock.since_s(self._updated_us)
        self._updated_us = self.clock.now_us
        motion = self._motion()
        x_m, y_m = self._as_seen_now(points)
        self._localizer.update(motion, self._compass_rad(), x_m, y_m, passed_s)
        if knew != self._localizer.localized:
            here_m = "({:.2f}, {:.2f})".format(*self._localizer.pose[:2])
            self.log.info(f"localized at {here_m} m" if not knew else "lost, searching the whole field")
        pose = self.pose.value
        pose.x_m, pose.y_m, pose.heading_rad = self._localizer.pose.tolist()
        pose.covariance = self._localizer.covariance.tolist()
        pose.localized = self._localizer.localized
        self.pose.write()

    def config_changed(self) -> None:
        self._localizer.change(line_map(self.config.field), self._settings())

    def _settings(self) -> LocalizerSettings:
        config = self.config
        return LocalizerSettings(
            reach_m=config.reach_m,
            points=config.points,
            search_period_s=config.search_period_s,
            lost_score=config.lost_score,
            good_score=config.good_score,
            errors=EXPECTED[config.realism],
        )

    def _compass_rad(self) -> float | None:
        imu = self.imu.value
        sound = self.imu.refreshed and plausible(imu.heading_rad, imu.yaw_rate_rad_s)
        return imu.heading_rad if sound else None

    def _as_seen_now(self, points: line_points_t) -> tuple[Floats, Floats]:
        """Returns the points (n each) in the frame of the robot that has driven on since their exposure."""
        seen_m = np.array((points.x_m, points.y_m)).T
        age_s = self.clock.since_s(points.capture_us) if points.capture_us else 0.0
        if not len(seen_m) or not 0.0 < age_s <= _STALE_S or self._last is None:
            return seen_m[:, 0], seen_m[:, 1]
        turn_rad = age_s * self._turning_rad_s
        way_m = rotation(turn_rad / 2) @ (age_s * self._last.vx_m_s, age_s * self._last.vy_m_s)
        with np.errstate(over="ignore", invalid="ignore"):  # values that cannot be are left out later
            seen_m = product(seen_m - way_m, rotation(turn_rad))
        return seen_m[:, 0], seen_m[:, 1]

    def _motion(self) -> Motion:
        """Returns the way since the last frame by the wheels and the turn by the gyro, which slip does not affect."""
        now = self.odometry.value
        sound = plausible(now.x_m, now.y_m, now.heading_rad, now.vx_m_s, now.vy_m_s)
        if not (self.odometry.refreshed and sound):
            return Motion(0.0, 0.0, 0.0, 0.0)
        before, passed_s = self._last or now, self.clock.since_s(self._last_us)
        self._last, self._last_us = now, self.clock.now_us
        turn_rad = now.heading_rad - before.heading_rad
        self._turning_rad_s = now.omega_rad_s if plausible(now.omega_rad_s) else 0.0
        way_m = rotation(-before.heading_rad - turn_rad / 2) @ (now.x_m - before.x_m, now.y_m - before.y_m)
        if np.hypot(*way_m) > _FASTEST_M_S * max(passed_s, self.clock.period_s):
            return Motion(0.0, 0.0, 0.0, 0.0)  # the driver began anew: its frame has moved, not the robot
        if self._compass_rad() is not None:
            rate_rad_s = self.imu.value.yaw_rate_rad_s
            if before is not now:
                turn_rad = (rate_rad_s + self._yaw_rate_rad_s) / 2 * passed_s
                self._turning_rad_s = (rate_rad_s + self._yaw_rate_rad_s) / 2
            self._yaw_rate_rad_s = rate_rad_s
        return Motion(float(way_m[0]), float(way_m[1]), wrap(turn_rad), float(np.hypot(now.vx_m_s, now.vy_m_s)))

"""Self-localization: matches white points with the field's lines, and follows the robot with odometry."""

from typing import NamedTuple

import numpy as np
from pydantic import Field as Setting
from pydantic import ValidationInfo, field_validator

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import line_points_t, pose_t
from procs.localization.dead_reckoning import DeadReckoning
from procs.localization.global_search import global_search
from procs.localization.line_map import line_map
from procs.localization.lost_report import LostReport
from procs.localization.pose_filter import motion_errors
from procs.localization.recent_motion import RecentMotion
from procs.localization.self_localizer import LocalizerSettings, SelfLocalizer
from procs.model.algebra import product
from procs.model.expected_errors import EXPECTED
from procs.model.exposures import AHEAD_S
from procs.model.field import Field, MatchField
from procs.model.frames import Floats, rotation
from procs.model.geometry import plausible, wrap_rad
from procs.model.realism import Realism
from procs.model.robot import FASTEST_RAD_S
from procs.model.units import heading_mistake
from procs.vision.calibration import MirrorConfig

_SHORT_S = 0.05  # up to this age of an exposure, the velocity of the last tick describes the motion well enough
_COMPASS_S = 0.5  # a heading of the compass counts for so long, turned on by gyro or wheels
_USUAL = MirrorConfig().mirror()  # the mirror for which the expected errors are stated
_AWAY_M = 2.0  # distance at which mirrors are compared


class SeenPoints(NamedTuple):
    """White points (n), in the robot frame of this tick, in metres."""

    x_m: Floats
    y_m: Floats
    moved: tuple[float, float] = (0.0, 0.0)
    """Standard deviations in m and rad of the motion since the exposure, if that was long ago."""


_NOTHING = SeenPoints(np.empty(0), np.empty(0))


class LocalizationConfig(Config):
    """Settings of the self-localization."""

    field: MatchField = Field()
    """Measures of the field."""
    start_x_m: float | None = Setting(None, frozen=True)
    """x of the robot's start in the world frame, if it is known; requires start_y_m and start_heading_rad. The start
    counts only at the beginning of a run."""
    start_y_m: float | None = Setting(None, frozen=True)
    """y of the robot's start; see start_x_m."""
    start_heading_rad: float | None = Setting(None, frozen=True)
    """Heading of the robot at its start; see start_x_m."""
    realism: Realism = "realistic"
    """Errors of the camera that the pose's covariance allows for: none, friendly, realistic or harsh."""
    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the camera; a picture with fewer pixels has larger errors."""
    reach_m: float = Setting(default=7.0, gt=0.5, le=12.0)
    """White points further away are not used."""
    points: int = Setting(default=100, ge=10)
    """Most white points of a frame that are used."""
    search_period_s: float = Setting(default=0.5, gt=0.0, le=60.0)
    """Time from one search of the whole field to the next while the pose is known."""
    lost_score: float = Setting(default=0.4, gt=0.0, lt=1.0)
    """The pose is given up when the mean score of the matches falls below this; 1 is a perfect fit."""
    good_score: float = Setting(default=0.5, gt=0.0, lt=1.0)
    """A lost robot accepts a pose only with at least this mean score."""

    @field_validator("start_heading_rad")
    @classmethod
    def _start_is_whole(cls, heading_rad: float | None, info: ValidationInfo) -> float | None:
        """Refuses an incomplete start, one outside the walls, and a heading in degrees."""
        if {"field", "start_x_m", "start_y_m"} <= info.data.keys():
            x_m, y_m, field = info.data["start_x_m"], info.data["start_y_m"], info.data["field"]
            if len({value is None for value in (x_m, y_m, heading_rad)}) > 1:
                raise ValueError("start_x_m, start_y_m and start_heading_rad belong together; give all three or none")
            if x_m is not None and not field.in_field(x_m, y_m, field.border_m):
                raise ValueError(f"start_x_m and start_y_m give ({x_m:g}, {y_m:g}), which is outside the walls")
        if heading_rad is not None and (mistake := heading_mistake(heading_rad)):
            raise ValueError(f"start_{mistake}")
        return heading_rad

    @field_validator("good_score")
    @classmethod
    def _above_lost_score(cls, good_score: float, info: ValidationInfo) -> float:
        """Refuses scores with which a robot is lost as soon as it is found."""
        lost_score = info.data.get("lost_score", 0.0)
        if good_score < lost_score:
            raise ValueError(f"good_score of {good_score:g} should be at least lost_score, which is {lost_score:g}")
        return good_score


class Localization(Component):
    """Publishes the pose in each tick; `localized` is false while the robot searches for its place on the field."""

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
        """Begins at the start of the settings, or lost."""
        config = self.config
        start = (config.start_x_m, config.start_y_m, config.start_heading_rad)
        given = [value for value in start if value is not None]
        self._motions = DeadReckoning(self.clock)
        self._localizer = self._new_localizer(np.array(given) if given else None)
        self._updated_us = -1
        self._recent = RecentMotion()
        self._lost = LostReport()
        self._captured_us = 0  # newest exposure of points
        self._compass_rad, self._compass_us = 0.0, -1  # newest heading of the compass, and the tick in which it came

    def loop(self) -> None:
        if self._updated_us < 0 and self.clock.tick > 1 + self.clock.every:
            self._localizer = self._new_localizer(None)  # restarted: the robot has left its start
        knew = self._localizer.localized
        passed_s = self.clock.period_s if self._updated_us < 0 else self.clock.since_s(self._updated_us)
        updated_us, self._updated_us = self._updated_us, self.clock.now_us
        yaw_rate_rad_s = self.imu.value.yaw_rate_rad_s if self._takes_compass() else None
        motion = self._motions.motion(self.odometry.value if self.odometry.refreshed else None, yaw_rate_rad_s)
        if 0 <= updated_us < self._updated_us:
            self._recent.add(updated_us, self._updated_us, motion)
        seen = self._as_seen_now(self.line_points.value) if self._sees_anew() else _NOTHING
        compass_rad = self._compass_now_rad() if len(seen.x_m) else None
        searches = self._localizer.searches
        self._localizer.update(motion, compass_rad, seen.x_m, seen.y_m, passed_s, seen.moved)
        if knew != self._localizer.localized:
            here_m = "({:.2f}, {:.2f})".format(*self._localizer.pose[:2])
            self.log.info(f"localized at {here_m} m" if not knew else "lost, searching the whole field")
        self._report(passed_s, len(seen.x_m), compass_rad is not None, self._localizer.searches > searches)
        pose = self.pose.value
        pose.x_m, pose.y_m, pose.heading_rad = self._localizer.pose.tolist()
        pose.covariance = self._localizer.covariance.tolist()
        pose.localized = self._localizer.localized
        self.pose.write()

    def _report(self, passed_s: float, points: int, has_heading: bool, searched: bool) -> None:
        """Logs from time to time the reason for which the robot does not find its place."""
        if self._localizer.localized:
            self._lost.clear()
            return
        message = self.line_points
        ahead_s = -self.clock.since_s(message.value.capture_us) if message.refreshed else None
        if self._lost.count(passed_s, ahead_s, points, has_heading, searched):
            self.log.warning(self._lost.text(self._localizer.places, self._settings()))

    def _new_localizer(self, start: Floats | None) -> SelfLocalizer:
        return SelfLocalizer(line_map(self.config.field), self._settings(), start)

    def config_changed(self) -> None:
        self._localizer.change(line_map(self.config.field), self._settings())

    def _settings(self) -> LocalizerSettings:
        """Returns the settings of the localizer; errors and correlation grow with the ground that a pixel covers."""
        config = self.config
        pixel_m, _ = config.mirror.mirror().metres_per_px(_AWAY_M)
        coarse = max(1.0, pixel_m / _USUAL.metres_per_px(_AWAY_M)[0])
        return LocalizerSettings(
            reach_m=config.reach_m,
            points=config.points,
            search_period_s=config.search_period_s,
            lost_score=config.lost_score,
            good_score=config.good_score,
            correlation=coarse**2 * LocalizerSettings.correlation,
            errors=EXPECTED[config.realism].in_coarser_picture(coarse),
        )

    def _takes_compass(self) -> bool:
        """Remembers the heading of a new message of compass and gyro; returns whether there is one that can be."""
        imu = self.imu.value
        sound = self.imu.refreshed and plausible(imu.heading_rad) and abs(imu.yaw_rate_rad_s) < FASTEST_RAD_S
        if sound:
            self._compass_rad, self._compass_us = imu.heading_rad, self.clock.now_us
        return sound

    def _compass_now_rad(self) -> float | None:
        """Returns the newest heading of the compass, turned on as the robot has turned since; None if it is too old."""
        if self._compass_us == self.clock.now_us:
            return self._compass_rad
        if self._compass_us < 0 or self.clock.since_s(self._compass_us) > _COMPASS_S:
            return None
        way = self._recent.since(self._compass_us)
        return None if way is None else wrap_rad(self._compass_rad + way.turn_rad)

    def _sees_anew(self) -> bool:
        """Returns whether there are points of a newer exposure; points of an exposure used already would count twice.

        An exposure in the future is none. Remembered, it would shut out all exposures until then.
        """
        if not self.line_points.refreshed:
            return False
        capture_us = self.line_points.value.capture_us
        if not capture_us:
            return True
        if capture_us <= self._captured_us or self.clock.since_s(capture_us) < -AHEAD_S:
            return False
        self._captured_us = capture_us
        return True

    def _as_seen_now(self, points: line_points_t) -> SeenPoints:
        """Returns the points in the robot frame of this tick: the robot has driven on since their exposure.

        Returns no points if the way since the exposure is not known, because wrong places of lines would be worse than
        none.
        Zeros are no points: a driver has filled its arrays up with them.
        """
        seen_m = np.array((points.x_m, points.y_m)).T
        seen_m = seen_m[seen_m.any(axis=1)]
        age_s = self.clock.since_s(points.capture_us) if points.capture_us else 0.0
        if not self._motions.has_begun and age_s > _SHORT_S:
            return _NOTHING
        if not len(seen_m) or age_s <= 0.0 or not self._motions.has_begun:
            return SeenPoints(seen_m[:, 0], seen_m[:, 1])
        moved, turn_rad = (0.0, 0.0), age_s * self._motions.turning_rad_s
        vx_m_s, vy_m_s = self._motions.velocity_m_s
        way_m = rotation(turn_rad / 2) @ (age_s * vx_m_s, age_s * vy_m_s)
        if age_s > _SHORT_S:
            way = self._recent.since(points.capture_us)
            if way is None:
                return _NOTHING
            way_m, turn_rad = way.shift_m, way.turn_rad
            error_m, error_rad = motion_errors(float(np.hypot(*way_m)), turn_rad, age_s)
            moved = error_m, float(np.hypot(error_rad, way.turn_sd_rad))
        with np.errstate(over="ignore", invalid="ignore"):  # values that cannot be are left out later
            seen_m = product(seen_m - way_m, rotation(turn_rad))
        return SeenPoints(seen_m[:, 0], seen_m[:, 1], moved)

"""Percepts drawn from the truth instead of pictures: same messages as camera and detectors, without rendering."""

import math

import numpy as np
from pydantic import Field as Setting
from pydantic import PositiveFloat, field_validator

from fwk import Clock, Component, Config, Logger, Reads, Writes, channel
from lcmtypes.soccer import (
    ball_percept_t,
    ground_truth_t,
    line_points_t,
    obstacle_percepts_t,
    obstacle_t,
    true_robot_t,
)
from procs.model.algebra import Floats, product
from procs.model.ball import BALL, BallModel
from procs.model.expected_errors import EXPECTED
from procs.model.field import Field, MatchField, Point
from procs.model.geometry import plausible
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, TEAM_NUMBERS, RobotModel, team_in
from procs.simulation.ball_sight import BallSight, candidate
from procs.simulation.delayed_truth import DelayedTruth, Exposure
from procs.simulation.gaps import Gaps
from procs.simulation.line_scan import line_scan
from procs.simulation.percept_errors import PRESETS
from procs.simulation.rendering.ground_view import half_pixels
from procs.simulation.sight import between_rays, blurred, claimed, displaced, glimpse_of, hidden
from procs.vision.calibration import MirrorConfig, below_mirror
from procs.vision.obstacle_finder import MOST_RAYS, across_rays_px, ray_count


class PerceptsConfig(Config):
    """Settings of the percepts; those that are not null override the preset."""

    mirror: MirrorConfig = MirrorConfig()
    """The camera that is imitated."""
    realism: Realism = "realistic"
    """Deviation of the percepts from the ideal: none, friendly, realistic or harsh."""
    latency_s: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Delay from the exposure until the percepts are published."""
    shake_px: float | None = Setting(default=None, ge=0.0, le=3.0)
    """Standard deviation by which the standing robot's mirror shakes, in pixels."""
    shake_px_per_m_s: float | None = Setting(default=None, ge=0.0, le=3.0)
    """Growth of that deviation with each m/s of the robot, in pixels."""
    ball_px: float | None = Setting(default=None, ge=0.0, le=50.0)
    """Standard deviation of the ball's place, in pixels."""
    ball_area_px: float | None = Setting(default=None, ge=0.0, le=50.0)
    """Relative standard deviation of the ball's area in the picture, times its radius in pixels."""
    ball_area_lost: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the ball's area that is not found."""
    line_blur_px: float | None = Setting(default=None, ge=0.0, le=50.0)
    """Least width in the picture, in pixels, of a line that blur leaves white."""
    worn: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the lines' paint that is missing."""
    ball_missed: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the frames in which a visible ball is not found."""
    robot_missed: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the frames in which a visible robot is not found."""
    team_missed: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the visible robots whose team is not recognized."""
    line_missed: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the line points that are not found."""
    ball_phantoms_1_s: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Balls a second that are not there."""
    mouth_phantoms_1_s: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Balls a second that seem to lie in the own mouth."""
    robot_phantoms_1_s: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Robots a second that are not there."""
    line_phantoms: float | None = Setting(default=None, ge=0.0, le=1.0)
    """Part of the points that do not lie on a line."""
    tilt_sd_deg: float | None = Setting(default=None, ge=0.0, le=2.0)
    """Standard deviation of the mirror's uncalibrated tilt about either axis, constant in a match."""
    gaps_1_min: float | None = Setting(default=None, ge=0.0, le=1e6)
    """Interruptions in a minute, in which frames are lost in a row."""
    gap_s: float | None = Setting(default=None, ge=0.0, le=60.0)
    """Mean duration of an interruption."""
    frozen: bool = False
    """The camera hangs: what its last picture shows comes again as if it were new."""
    field: MatchField = Field()
    """Measures of the field."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size of the ball."""
    rays: int = Setting(default=180, ge=60, le=MOST_RAYS)
    """Scan lines around the robot, as the detector of lines has them; more for robots that are narrower than usual."""
    ring_distances_m: tuple[PositiveFloat, ...] = (0.7, 1.1, 1.6, 2.2, 2.9, 3.7, 4.6)
    """Radii of the rings, as the detector of lines has them."""
    reach_m: float = Setting(default=7.0, gt=0.5, le=20.0)
    """Where the detector's rays end; it finds robots and lines of which they show enough before, and none where the
    mirror shows no ground."""
    ball_reach_m: float = Setting(default=8.0, gt=0.0, le=20.0)
    """Largest distance of a ball; it is less where the mirror shows less."""
    most_points: int = Setting(default=150, ge=1, le=10_000)
    """Line points sent at most."""
    least_visible: float = Setting(default=0.4, gt=0.0, le=1.0)
    """Least visible part of a ball or a robot that is found; also the confidence in a ball that is not there.
    ER-Force's threshold."""
    beyond_line_px: float = Setting(default=2.5, ge=0.0, le=50.0)
    """Pixels of the picture that the detector needs beyond a line. Fitted to rendered pictures."""
    beyond_robot_px: float = Setting(default=4.2, ge=0.0, le=50.0)
    """Pixels of the picture that the detector needs beyond the near edge of a robot. Fitted to rendered pictures."""
    ball_phantom_m: float = Setting(default=0.5, gt=0.0, le=20.0)
    """Least distance of a ball that is not there, in metres; the largest is the ball's. An estimate."""
    robot_phantom_m: float = Setting(default=0.6, gt=0.0, le=20.0)
    """Least distance of a robot that is not there, in metres; the largest is that of robots. An estimate."""
    line_phantom_share: float = Setting(default=0.8, ge=0.0, le=2.0)
    """Distance of a point that does not lie on a line, as a part of that of the line behind it. An estimate."""

    _visible = field_validator("ball")(below_mirror)


class Percepts(Component):
    """Stands in for camera, `omni_ball` and `omni_field` of one robot."""

    stage = "sensor_prepare"

    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    ball_percept: Writes[ball_percept_t]
    obstacle_percepts: Writes[obstacle_percepts_t]
    line_points: Writes[line_points_t]
    config: PerceptsConfig
    clock: Clock
    log: Logger
    rng: np.random.Generator

    @classmethod
    def preload(cls, config: PerceptsConfig) -> None:
        """Cuts the field's lines into pieces, which are the same for all robots."""
        line_scan(config.field)

    def init(self) -> None:
        self._delayed = DelayedTruth(self.name, "percepts", self.log)
        self._before_us = -1
        self._looked = False
        built, interrupted, self._mouth_rng, self._marker_rng = self.rng.spawn(4)
        self._tilts = built.standard_normal(2)
        self._gaps = Gaps(interrupted)
        self._apply_settings()

    def loop(self) -> None:
        if not self.ground_truth.refreshed:
            return
        seen = self._delayed.expose(self.ground_truth, self._errors.latency_s)
        passed_s = self.clock.period_s if self._before_us < 0 else self.clock.since_s(self._before_us)
        self._before_us = self.clock.now_us
        if seen is None or self._gaps.blind(self.clock.now_us, self._errors.gaps_1_min, self._errors.gap_s):
            return
        if not (self.config.frozen and self._looked):
            self._look(seen, passed_s)
        for port in (self.ball_percept, self.obstacle_percepts, self.line_points):
            port.value.capture_us = seen.capture_us
            port.write()

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        self._errors = chosen(PRESETS[self.config.realism], self.config)
        self._mirror = self.config.mirror.mirror()
        roll_rad, pitch_rad = (math.radians(self._errors.tilt_sd_deg) * self._tilts).tolist()
        self._tilt_rad = roll_rad, pitch_rad
        self._stated = EXPECTED[self.config.realism]
        end_px = min(self._mirror.radius_px(self.config.reach_m), self._mirror.size_px / 2 - 1)
        beyond_px = self.config.beyond_line_px, self.config.beyond_robot_px
        self._line_reach_px = end_px - beyond_px[0]
        self._line_reach_m, edge_m = (self._mirror.distance_m(end_px - spare) for spare in beyond_px)
        body_px = self._mirror.radius_px(self.config.robot.radius_m)
        self._body_m = self._mirror.distance_m(body_px + beyond_px[0])
        self._robot_reach_m = edge_m + self.config.robot.radius_m
        radius_m = self.config.ball.radius_m
        self._ball_reach_m = min(self.config.ball_reach_m, self._mirror.reach_m(radius_m))
        self._ball_sight = BallSight(
            self._mirror,
            radius_m,
            self._ball_reach_m,
            self._errors,
            self.config.least_visible,
            self._stated.ball_px,
        )
        self._lines = line_scan(self.config.field)
        self._rays = ray_count(self.config.rays, self.config.robot.radius_m)

    def _look(self, seen: Exposure, passed_s: float) -> None:
        """Draws all percepts of a frame, `passed_s` after the last one."""
        self._looked, own = True, seen.own
        forward, left = half_pixels(self._errors.drawn_shake_px(own, self.rng))
        shake_px = forward / 2, left / 2
        others = [(robot.x_m, robot.y_m) for robot in seen.others]
        robots_m = _seen_from(own, np.array(others).reshape(-1, 2))
        self._see_ball(own, seen.truth, robots_m, shake_px, passed_s)
        teams = [TEAM_NUMBERS.get(team_in(robot), obstacle_t.TEAM_UNKNOWN) for robot in seen.others]
        self._see_robots(robots_m, teams, shake_px, passed_s)
        self._see_lines(own, robots_m, shake_px)

    def _see_ball(
        self, own: true_robot_t, truth: ground_truth_t, robots_m: Floats, shake_px: tuple[float, float], passed_s: float
    ) -> None:
        errors, percept = self._errors, ball_percept_t()
        missed, *noise = self.rng.random(), *self.rng.standard_normal(3)
        phantom, direction, distance = self.rng.random(3)
        if plausible(truth.ball_x_m, truth.ball_y_m, truth.ball_z_m) and missed >= errors.ball_missed:
            at_m = _seen_from(own, np.array([(truth.ball_x_m, truth.ball_y_m)]))
            robot, radius_m = self.config.robot, self.config.ball.radius_m
            bodies_m = robots_m if truth.ball_z_m <= robot.height_m else robots_m[:0]
            glimpse = glimpse_of(at_m[0], radius_m, bodies_m, robot.radius_m)
            (along,), (across,) = self._moved(at_m, shake_px, truth.ball_z_m + radius_m)
            percept = self._ball_sight.found(at_m, truth.ball_z_m, glimpse, (along, across), noise)
        if phantom < -math.expm1(-errors.ball_phantoms_1_s * passed_s):
            least_m = self.config.ball_phantom_m
            range_m, angle_rad = least_m + distance * (self._ball_reach_m - least_m), direction * math.tau
            x_m, y_m = range_m * math.cos(angle_rad), range_m * math.sin(angle_rad)
            ghost = self._ball_sight.on_ground(x_m, y_m, self.config.least_visible)
            if percept.visible:
                percept.others = [candidate(ghost)]
            else:
                percept = ghost
        if not percept.visible and self._mouth_rng.random() < -math.expm1(-errors.mouth_phantoms_1_s * passed_s):
            in_mouth_m = self.config.robot.held_ball_m(self.config.ball)
            percept = self._ball_sight.on_ground(in_mouth_m, 0.0, self.config.least_visible)
        self.ball_percept.value = percept

    def _see_robots(self, robots_m: Floats, teams: list[int], shake_px: tuple[float, float], passed_s: float) -> None:
        errors, config = self._errors, self.config
        known = self._marker_rng.random(len(robots_m)) >= errors.team_missed
        luck, noise = self.rng.random(len(robots_m)), self.rng.standard_normal(len(robots_m))
        phantom, direction, distance = self.rng.random(3)
        moved_px = self._moved(robots_m, shake_px)
        moved_m = between_rays(self._mirror, robots_m, moved_px, noise, config.robot.radius_m, self._rays)
        near = np.hypot(moved_m[:, 0], moved_m[:, 1]) <= self._robot_reach_m
        most_hidden = 1 - config.least_visible
        free = hidden(robots_m, robots_m, config.robot.radius_m) < most_hidden
        seen = near & free & (luck >= errors.robot_missed)
        moved_m = moved_m[seen]
        colours = np.where(known, np.array(teams, int), obstacle_t.TEAM_UNKNOWN)[seen].tolist()
        if phantom < -math.expm1(-errors.robot_phantoms_1_s * passed_s):
            least_m = config.robot_phantom_m
            range_m, angle_rad = least_m + distance * (self._robot_reach_m - least_m), direction * math.tau
            moved_m = np.vstack((moved_m, range_m * np.array((math.cos(angle_rad), math.sin(angle_rad)))))
            colours.append(obstacle_t.TEAM_UNKNOWN)
        percepts = self.obstacle_percepts.value = obstacle_percepts_t()
        along_px, across_px = self._stated.robot_px
        for (x_m, y_m), team in zip(moved_m.tolist(), colours, strict=True):
            obstacle = obstacle_t()
            obstacle.team = team
            obstacle.x_m, obstacle.y_m, obstacle.radius_m = x_m, y_m, config.robot.radius_m
            stated_px = along_px, across_rays_px(self._mirror, math.hypot(x_m, y_m), self._rays, across_px)
            obstacle.covariance_m2 = claimed(self._mirror, x_m, y_m, stated_px)
            percepts.obstacles.append(obstacle)

    def _see_lines(self, own: true_robot_t, robots_m: Floats, shake_px: tuple[float, float]) -> None:
        errors, config = self._errors, self.config
        place = Point(own.x_m, own.y_m)
        found_m = self._lines.points(
            place,
            own.heading_rad,
            self._rays,
            config.ring_distances_m,
            self._mirror.distance_m(self._line_reach_px + math.hypot(*shake_px)),
            self._mirror,
            errors,
            self.rng,
        )
        luck = self.rng.random((2, len(found_m)))
        found_m[luck[1] < errors.line_phantoms] *= config.line_phantom_share
        seen = (luck[0] >= errors.line_missed) & (hidden(found_m, robots_m, config.robot.radius_m) <= 0)
        moved_m = blurred(self._mirror, found_m, *self._moved(found_m, shake_px))
        range_m = np.hypot(moved_m[:, 0], moved_m[:, 1])
        moved_m = moved_m[seen & (range_m >= self._body_m) & (range_m <= self._line_reach_m)]
        if len(moved_m) > config.most_points:
            moved_m = moved_m[np.linspace(0, len(moved_m) - 1, config.most_points).astype(int)]
        points = self.line_points.value
        points.x_m, points.y_m = moved_m.T.tolist()

    def _moved(self, points_m: Floats, shake_px: tuple[float, float], height_m: float = 0.0) -> tuple[Floats, Floats]:
        """Returns the pixels (n) along and across each ray by which shake and tilt move what points (n, 2) show."""
        return displaced(self._mirror, points_m, shake_px, self._tilt_rad, height_m)


def _seen_from(own: true_robot_t, points_m: Floats) -> Floats:
    """Returns points (n, 2) of the world frame in the robot frame."""
    cosine, sine = math.cos(own.heading_rad), math.sin(own.heading_rad)
    return product(points_m - (own.x_m, own.y_m), np.array(((cosine, -sine), (sine, cosine))))

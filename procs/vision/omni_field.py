"""Finds points on the field's lines, and other robots, in the omnidirectional camera's picture."""

import numpy as np
from pydantic import Field as Setting
from pydantic import PositiveFloat, ValidationInfo, field_validator

from fwk import Writes
from lcmtypes.soccer import line_points_t, obstacle_percepts_t, obstacle_t
from procs.model.algebra import Floats
from procs.model.expected_errors import EXPECTED
from procs.model.field import Field, MatchField
from procs.model.robot import ROBOT, RobotModel
from procs.vision.colours import ColourRange, Hsv, Picture, not_below, to_hsv
from procs.vision.detector import Detector, DetectorConfig
from procs.vision.line_finder import LineFinder
from procs.vision.marker_finder import MarkerFinder
from procs.vision.obstacle_finder import MOST_RAYS, Obstacle, ObstacleFinder, ray_count
from procs.vision.scan import Scan

_BESIDE_BODY_M = 0.03  # distance from the robot's own body to the begin of the rays
_WIDEST, _NARROWEST = 3.2, 0.4  # longest and shortest stretch of white on a line, as multiples of its width ...
_BLURRED_M = 0.15  # ... and the longest one on a narrow line, which pixels blur


class OmniFieldConfig(DetectorConfig):
    """Settings of the detector of lines and obstacles."""

    rays: int = Setting(default=180, ge=60, le=MOST_RAYS)
    """Number of rays around the robot. With fewer than 60, a robot 3 m away fits between two of them. More rays are
    used if the other robots are narrower than usual."""
    robot: RobotModel = ROBOT
    """Geometry of the other robots."""
    field: MatchField = Field()
    """Measures of the field; the width of its lines separates them from other white things."""
    nearest_m: float | None = Setting(default=None, gt=0.0)
    """Distance at which the rays begin; null: just outside the robot's own body."""
    farthest_m: float = Setting(default=7.0, gt=0.5, le=20.0)
    """Distance at which the rays end; they end earlier where the mirror shows no ground."""
    ring_distances_m: tuple[PositiveFloat, ...] = (0.7, 1.1, 1.6, 2.2, 2.9, 3.7, 4.6)
    """Radii of the rings, which meet the lines that run towards the robot; rings that the mirror does not show are left
    out."""
    most_points: int = Setting(default=150, ge=1, le=10_000)
    """Most line points that are published, picked evenly from those found."""
    deviation_px: tuple[PositiveFloat, PositiveFloat] | None = None
    """Standard deviation of a robot's middle in the picture, along and across the ray; null: by `realism`."""
    green_low: Hsv = (38, 70, 40)
    """Least hue (0..179), saturation and value (0..255) of the carpet."""
    green_high: Hsv = (90, 255, 255)
    """Greatest hue, saturation and value of the carpet."""
    white_low: Hsv = (0, 0, 150)
    """Least hue, saturation and value of the lines."""
    white_high: Hsv = (179, 60, 255)
    """Greatest hue, saturation and value of the lines."""
    black_low: Hsv = (0, 0, 0)
    """Least hue, saturation and value of the robots' bodies."""
    black_high: Hsv = (179, 255, 70)
    """Greatest hue, saturation and value of the robots' bodies."""
    cyan_low: Hsv = (78, 90, 60)
    """Least hue, saturation and value of cyan markers."""
    cyan_high: Hsv = (112, 255, 255)
    """Greatest hue, saturation and value of cyan markers."""
    magenta_low: Hsv = (138, 90, 60)
    """Least hue, saturation and value of magenta markers."""
    magenta_high: Hsv = (172, 255, 255)
    """Greatest hue, saturation and value of magenta markers."""

    _possible = field_validator("green_high", "white_high", "black_high", "cyan_high", "magenta_high")(not_below)

    @field_validator("farthest_m")
    @classmethod
    def _not_nearer(cls, farthest_m: float, info: ValidationInfo) -> float:
        """Refuses rays that end before they begin; what they depend on has been checked before."""
        if {"mirror", "robot", "nearest_m"} <= info.data.keys():
            reach_m = info.data["mirror"].mirror().reach_m()
            begin_m = _begin_m(info.data["nearest_m"], info.data["robot"])
            if begin_m >= farthest_m:
                raise ValueError(f"the rays begin at {begin_m:g} m; farthest_m should be greater")
            if begin_m >= reach_m:
                raise ValueError(
                    f"the rays begin at {begin_m:g} m, but the mirror shows no ground beyond {reach_m:.2f} m"
                )
        return farthest_m


class OmniField(Detector):
    """Publishes points on lines and other robots, found along rays and rings of every frame."""

    line_points: Writes[line_points_t]
    obstacle_percepts: Writes[obstacle_percepts_t]
    config: OmniFieldConfig

    @classmethod
    def preload(cls, config: OmniFieldConfig) -> None:
        """Computes the scan lines, which are the same for all robots."""
        _star(config)
        _rings(config)

    def detect(self, pixels: Picture) -> None:
        points_m, obstacles = self._find(pixels)
        self._write(points_m, obstacles, self._markers.find(pixels, [(each.x_m, each.y_m) for each in obstacles]))

    def report_nothing(self) -> None:
        self._write(np.empty((0, 2)), [], [])

    def apply_settings(self) -> None:
        config = self.config
        mirror = config.mirror.mirror()
        green = ColourRange(config.green_low, config.green_high)
        white = ColourRange(config.white_low, config.white_high)
        black = ColourRange(config.black_low, config.black_high)
        self._star, self._rings = _star(config), _rings(config)
        line_m = config.field.line_width_m
        self._lines = LineFinder(
            green, white, widest_m=max(_WIDEST * line_m, _BLURRED_M), narrowest_m=_NARROWEST * line_m
        )
        teams = ColourRange(config.cyan_low, config.cyan_high), ColourRange(config.magenta_low, config.magenta_high)
        self._markers = MarkerFinder(mirror, teams, config.robot.radius_m, config.robot.marker_m)
        deviation_px = config.deviation_px or EXPECTED[config.realism].robot_px
        self._obstacles = ObstacleFinder(mirror, self._star, black, (green, white), config.robot.radius_m, deviation_px)

    def _find(self, pixels: Picture) -> tuple[Floats, list[Obstacle]]:
        star, rings = to_hsv(self._star.look_up(pixels)), to_hsv(self._rings.look_up(pixels))
        points_m = np.vstack([self._lines.find(star, self._star), self._lines.find(rings, self._rings)])
        if len(points_m) > self.config.most_points:
            points_m = points_m[np.linspace(0, len(points_m) - 1, self.config.most_points).astype(int)]
        return points_m, self._obstacles.find(star)

    def _write(self, points_m: Floats, obstacles: list[Obstacle], teams: list[int]) -> None:
        points, percepts = self.line_points.value, self.obstacle_percepts.value
        points.x_m, points.y_m = points_m.T.tolist()
        points.capture_us = percepts.capture_us = self.capture_us
        percepts.obstacles = [self._message(*each) for each in zip(obstacles, teams, strict=True)]
        self.line_points.write()
        self.obstacle_percepts.write()

    def _message(self, obstacle: Obstacle, team: int) -> obstacle_t:
        message = obstacle_t()
        message.team = team
        message.x_m, message.y_m = obstacle.x_m, obstacle.y_m
        message.radius_m = self.config.robot.radius_m
        message.covariance_m2 = obstacle.covariance_m2.tolist()
        return message


def _begin_m(nearest_m: float | None, robot: RobotModel) -> float:
    """Returns the distance at which the rays begin."""
    return nearest_m or robot.radius_m + _BESIDE_BODY_M


def _star(config: OmniFieldConfig) -> Scan:
    nearest_m = _begin_m(config.nearest_m, config.robot)
    rays = ray_count(config.rays, config.robot.radius_m)
    return Scan.star(config.mirror.mirror(), rays, nearest_m, config.farthest_m)


def _rings(config: OmniFieldConfig) -> Scan:
    return Scan.rings(config.mirror.mirror(), config.ring_distances_m)

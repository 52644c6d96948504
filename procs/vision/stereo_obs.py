"""Finds obstacles on the ground in the pictures of a forward stereo pair."""

import cv2
from pydantic import Field as Setting
from pydantic import ValidationInfo, field_validator

from fwk import Component, Config, Image, Writes
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t
from procs.model.ball import BALL, BallModel
from procs.model.expected_errors import EXPECTED
from procs.model.realism import Realism
from procs.model.robot import ROBOT, RobotModel
from procs.vision.exposure import captured_us
from procs.vision.stereo_finder import LONGEST_PX, StereoFinder
from procs.vision.stereo_rig import StereoRig

_ABOVE_BALL_M = 0.03  # distance from the top of the ball to the heights that count
_LEAST_BAND_M = 0.25  # least extent of the heights that count
_LOWEST_M, _LOWEST = 0.28, 0.55  # lower limit of these heights, and the same as a share of the height of low robots


class StereoObsConfig(Config):
    """Settings of the detector."""

    rig: StereoRig = StereoRig()
    """Calibration of the pair; frames of another aspect are cropped to their central part, and frames with a
    focal length above 400 px scaled down before the search."""
    robot: RobotModel = ROBOT
    """Geometry of the other robots."""
    ball: BallModel = BALL
    """Size of the ball, which is no obstacle."""
    farthest_m: float = Setting(default=4.5, gt=0.5, le=20.0)
    """Obstacles further ahead are not reported."""
    realism: Realism = "realistic"
    """Errors of the cameras that covariances allow for: none, friendly, realistic or harsh."""
    deviation_px: float | None = Setting(default=None, gt=0.0, le=50.0)
    """Standard deviation of a disparity, in pixels of the frames that are searched; null: by `realism`."""
    latency_s: float = Setting(default=0.0, ge=0.0, le=1.0)
    """Time from the exposure of a frame to its publication, for cameras that do not state the exposure."""

    @field_validator("ball")
    @classmethod
    def _below_robots(cls, ball: BallModel, info: ValidationInfo) -> BallModel:
        """Refuses a ball as high as the robots; the setting `robot` has been checked before."""
        if "robot" in info.data:
            height_m, lowest_m = info.data["robot"].height_m, _lowest_m(info.data["robot"], ball)
            if height_m <= lowest_m:
                raise ValueError(
                    f"above a ball of {2 * ball.radius_m:g} m, heights from {lowest_m:g} m on count; "
                    f"robots of {height_m:g} m should be higher, or the ball smaller"
                )
        return ball

    @field_validator("farthest_m")
    @classmethod
    def _not_nearer(cls, farthest_m: float, info: ValidationInfo) -> float:
        """Refuses a distance up to which the pair, checked before, measures nothing or sees no robot."""
        if "rig" in info.data:
            rig: StereoRig = info.data["rig"]
            nearest_m = StereoFinder(rig.reduced(LONGEST_PX)).nearest_m
            if nearest_m >= farthest_m:
                raise ValueError(f"the pair measures from {nearest_m:.3f} m on; farthest_m should be greater")
            if {"robot", "ball"} <= info.data.keys():
                robot: RobotModel = info.data["robot"]
                lowest_m, highest_m = _heights_m(robot, info.data["ball"])
                shown_m = rig.shows_from_m((lowest_m + min(highest_m, robot.height_m)) / 2) + robot.radius_m
                if shown_m >= farthest_m:
                    raise ValueError(
                        f"the pair, {rig.height_m:g} m high, shows robots from {shown_m:.3f} m on; "
                        "farthest_m should be greater, or the height nearer to that of robots"
                    )
        return farthest_m


class StereoObs(Component):
    """Publishes the obstacles in every pair of frames."""

    stage = "sensor_prepare"
    stereo_image: Image
    stereo_obstacles: Writes[obstacle_percepts_t]
    config: StereoObsConfig

    def init(self) -> None:
        cv2.setNumThreads(1)
        self.config_changed()

    def loop(self) -> None:
        if not self.stereo_image.changed:
            return
        pixels = self.stereo_image.pixels
        percepts = self.stereo_obstacles.value = obstacle_percepts_t()
        percepts.capture_us = captured_us(self.stereo_image, self.config.latency_s)
        for found in [] if pixels is None else self._finder.find(self.config.rig.cropped(pixels)):
            obstacle = obstacle_t()
            obstacle.x_m, obstacle.y_m = float(found.x_m), float(found.y_m)
            obstacle.radius_m = self.config.robot.radius_m
            obstacle.covariance_m2 = found.covariance_m2.tolist()
            percepts.obstacles.append(obstacle)
        self.stereo_obstacles.write()

    def config_changed(self) -> None:
        config = self.config
        lowest_m, highest_m = _heights_m(config.robot, config.ball)
        self._finder = StereoFinder(
            config.rig.reduced(LONGEST_PX),
            lowest_m=lowest_m,
            highest_m=highest_m,
            farthest_m=config.farthest_m,
            radius_m=config.robot.radius_m,
            deviation_px=config.deviation_px or EXPECTED[config.realism].stereo_px,
        )


def _heights_m(robot: RobotModel, ball: BallModel) -> tuple[float, float]:
    """Returns the lower and the upper edge of the heights that are looked at."""
    lowest_m = _lowest_m(robot, ball)
    return lowest_m, max(StereoFinder.highest_m, lowest_m + _LEAST_BAND_M)


def _lowest_m(robot: RobotModel, ball: BallModel) -> float:
    """Returns the lower limit of the heights that count."""
    return max(2 * ball.radius_m + _ABOVE_BALL_M, min(_LOWEST_M, _LOWEST * robot.height_m))

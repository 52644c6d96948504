"""Finds the ball in the omnidirectional camera's picture."""

from pydantic import Field as Setting
from pydantic import field_validator

from fwk import Writes
from lcmtypes.soccer import ball_candidate_t, ball_percept_t
from procs.model.ball import BALL, BallModel
from procs.model.expected_errors import EXPECTED
from procs.vision.ball_finder import BallFinder, BallSighting
from procs.vision.calibration import below_mirror
from procs.vision.colours import ColourRange, Hsv, Picture, not_below
from procs.vision.detector import Detector, DetectorConfig


class OmniBallConfig(DetectorConfig):
    """Settings of the ball detector."""

    ball_low: Hsv = (4, 120, 80)
    """Least hue (0..179), saturation and value (0..255) of the ball's colour."""
    ball_high: Hsv = (20, 255, 255)
    """Greatest hue, saturation and value of the ball's colour."""
    ball: BallModel = BALL
    """Size of the ball."""
    deviation_px: float | None = Setting(default=None, gt=0.0, le=50.0)
    """Standard deviation of the ball's centre in the picture, with the shaking of the mirror; null: by `realism`."""
    least_fit: float = Setting(default=0.4, gt=0.0, lt=1.0)
    """Least visible share of the ball's area; a ball of which less is visible is not reported."""
    farthest_m: float = Setting(default=8.0, gt=0.0, le=20.0)
    """Balls further away are not reported."""

    _possible = field_validator("ball_high")(not_below)
    _visible = field_validator("ball")(below_mirror)


class OmniBall(Detector):
    """Publishes the ball, or that none is visible."""

    ball_percept: Writes[ball_percept_t]
    config: OmniBallConfig

    def apply_settings(self) -> None:
        config = self.config
        colour = ColourRange(config.ball_low, config.ball_high)
        mirror = config.mirror.mirror()
        deviation_px = config.deviation_px or EXPECTED[config.realism].ball_px
        self._finder = BallFinder(
            mirror, colour, config.ball.radius_m, deviation_px, config.least_fit, config.farthest_m
        )

    def detect(self, pixels: Picture) -> None:
        self._write(self._finder.find_all(pixels))

    def report_nothing(self) -> None:
        self._write([])

    def _write(self, balls: list[BallSighting]) -> None:
        percept = self.ball_percept.value = ball_percept_t()
        percept.capture_us = self.capture_us
        if balls:
            percept.visible = True
            _fill(percept, balls[0])
        for ball in balls[1:]:
            other = ball_candidate_t()
            _fill(other, ball)
            percept.others.append(other)
        self.ball_percept.write()


def _fill(message: ball_percept_t | ball_candidate_t, ball: BallSighting) -> None:
    message.x_m, message.y_m, message.z_m = ball.x_m, ball.y_m, ball.z_m
    message.covariance_m2 = ball.covariance_m2.tolist()
    message.confidence = ball.confidence

"""A view of any system: everything in it that has a position."""

import math
from typing import Any

from fwk.web.scene import Newest, Scene
from fwk.web.view import View

_COLOURS = ("#1e88e5", "#e53935", "#43a047", "#fb8c00", "#8e24aa", "#00897b", "#6d4c41", "#c0ca33")
_RADIUS_M = 0.1


class GeneralView(View):
    """Draws each message with `x_m` and `y_m` as a point, with its heading and covariance if it has them."""

    title = "Positions"
    channels = ("*",)
    members = ("x_m", "y_m")
    rate_hz = 5.0

    def draw(self, newest: Newest, scene: Scene) -> None:
        """Draws the newest messages."""
        for number, (channel, value) in enumerate(newest.matching("*").items()):
            if isinstance(value.x_m, float) and isinstance(value.y_m, float):
                scene.layer(channel)
                _draw(scene, channel, value, _COLOURS[number % len(_COLOURS)])


def _draw(scene: Scene, channel: str, value: Any, colour: str) -> None:
    x_m, y_m = value.x_m, value.y_m
    scene.circle(x_m, y_m, _RADIUS_M, fill=colour, pick=channel, trail=channel)
    scene.text(x_m, y_m + 3 * _RADIUS_M, channel, colour, 2 * _RADIUS_M)
    heading_rad = getattr(value, "heading_rad", None)
    if isinstance(heading_rad, float):
        nose = x_m + 3 * _RADIUS_M * math.cos(heading_rad), y_m + 3 * _RADIUS_M * math.sin(heading_rad)
        scene.line([(x_m, y_m), nose], colour)
    covariance = getattr(value, "covariance", getattr(value, "covariance_m2", None))
    if covariance:
        scene.ellipse(x_m, y_m, covariance, colour)

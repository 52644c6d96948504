"""Draws the detections of a robot over the images of its cameras, for the web console.

The calibration comes from the settings of the components that share it: the cameras and detectors of the robot.
"""

import math
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from fwk.web import Newest, Scene
from lcmtypes.core import frame_t
from lcmtypes.soccer import ball_candidate_t, ball_percept_t, line_points_t, obstacle_percepts_t, obstacle_t
from procs.model.algebra import Floats
from procs.model.ball import BALL
from procs.model.robot import TEAM_NUMBERS
from procs.view.measures import recent
from procs.vision.calibration import MirrorConfig
from procs.vision.stereo_rig import StereoRig

SEES = ("ball_percept", "obstacle_percepts", "line_points", "stereo_obstacles")
"""Channels beside a camera with the detections in its images."""
CALIBRATION = ("mirror", "rig", "ball")
"""Groups of settings with the calibration of the mirror and of the stereo pair, and the size of the ball."""
_BALL = "#ffee58"
_OBSTACLE = "#ff4081"
_LINE = "#00e5ff"
_TEAMS = {number: team for team, number in TEAM_NUMBERS.items()}
_STEPS = 24  # number of points on the outline of a foot
_NEAREST_M = 0.05  # ahead of the stereo pair; nearer points are not drawn


class _Lens(Protocol):
    """Maps points of the robot frame to pixels of an image."""

    def project(self, points_m: Floats) -> Floats:
        """Returns the pixels (n, 2) of points (n, 3) of a thing; NaN where the image does not show them."""


class _StereoLens:
    """The left image of the stereo pair, which is the left half of the frame."""

    def __init__(self, rig: StereoRig, width_px: int, height_px: int) -> None:
        self._rig = rig
        self._scale = np.array((width_px / (2 * rig.width_px), height_px / rig.height_px))

    def project(self, points_m: Floats) -> Floats:
        rig = self._rig
        ahead_m = points_m[:, 0] - rig.forward_m
        ahead_m = np.where(ahead_m > _NEAREST_M, ahead_m, np.nan)
        columns = (rig.width_px - 1) / 2 + rig.focal_px * (rig.baseline_m / 2 - points_m[:, 1]) / ahead_m
        rows = (rig.height_px - 1) / 2 + rig.focal_px * (rig.height_m - points_m[:, 2]) / ahead_m
        if not ((columns >= 0) & (columns < rig.width_px)).any():
            return np.full((len(points_m), 2), np.nan)
        # The part of a thing that is beside the image is drawn at its edge.
        pixels = np.clip(np.column_stack((columns, rows)), 0.0, (rig.width_px - 1, rig.height_px - 1))
        return np.asarray(pixels * self._scale)


class _MirrorLens:
    """The omnidirectional camera, whose image is the central square of the frame."""

    def __init__(self, calibration: dict[str, Any], width_px: int, height_px: int) -> None:
        size_px = min(width_px, height_px)
        self.mirror = replace(MirrorConfig(**calibration).mirror(), size_px=size_px)
        self.shift_px = np.array(((width_px - size_px) // 2, (height_px - size_px) // 2), np.float64)

    def project(self, points_m: Floats) -> Floats:
        return np.asarray(self.mirror.project(points_m) + self.shift_px)


def draw_sight(camera: str, newest: Newest, scene: Scene) -> None:
    """Draws ball, obstacles and points on lines over the image of a camera, whose scene is measured in pixels."""
    space, _, name = camera.rpartition("/")
    frame: frame_t | None = newest(camera)
    if frame is None:
        return

    def found(detections: str) -> Any:
        return recent(newest(f"{space}/{detections}"), frame)

    if name == "stereo_image":
        rig = StereoRig(**newest.settings(f"{space}/*", "rig"))
        _draw_obstacles(found("stereo_obstacles"), _StereoLens(rig, frame.width_px, frame.height_px), scene)
        return
    lens = _MirrorLens(newest.settings(f"{space}/*", "mirror"), frame.width_px, frame.height_px)
    _draw_lines(found("line_points"), lens, scene)
    _draw_obstacles(found("obstacle_percepts"), lens, scene)
    ball_radius_m = newest.settings(f"{space}/*", "ball").get("radius_m", BALL.radius_m)
    _draw_ball(found("ball_percept"), ball_radius_m, lens, scene)


def _draw_ball(ball: ball_percept_t | None, radius_m: float, lens: _MirrorLens, scene: Scene) -> None:
    scene.layer("ball")
    if ball is None or not ball.visible:
        return
    words = f"ball {math.hypot(ball.x_m, ball.y_m):.1f} m, {ball.confidence:.0%}"
    if ball.z_m > 0.0:
        words += f", {ball.z_m:.1f} m high"
    _draw_ring(ball, radius_m, lens, scene, 1.5, words)
    for other in ball.others:
        _draw_ring(other, radius_m, lens, scene, 0.7, f"{other.confidence:.0%}")


def _draw_ring(
    ball: ball_percept_t | ball_candidate_t,
    radius_m: float,
    lens: _MirrorLens,
    scene: Scene,
    width_px: float,
    words: str,
) -> None:
    """Draws the outline of a candidate for the ball, with words above it."""
    column, row, radius_px = lens.mirror.sphere((ball.x_m, ball.y_m, ball.z_m + radius_m), radius_m)
    if not radius_px > 0.0:  # straight above the mirror
        return
    x_px, y_px = column + lens.shift_px[0], row + lens.shift_px[1]
    scene.circle(x_px, y_px, radius_px + 2.0, stroke=_BALL, width_m=width_px)
    scene.text(x_px, y_px - radius_px - 10.0, words, _BALL, 10.0)


def _draw_obstacles(found: obstacle_percepts_t | None, lens: _Lens, scene: Scene) -> None:
    scene.layer("obstacles")
    for obstacle in found.obstacles if found else ():
        outline = lens.project(_foot(obstacle))
        points = [(float(x), float(y)) for x, y in outline]
        if np.isfinite(outline).all():
            scene.polygon(points, stroke=_OBSTACLE, width_m=1.5)
            distance_m = math.hypot(obstacle.x_m, obstacle.y_m)
            team = _TEAMS.get(obstacle.team, "")
            scene.text(*points[0], f"{team} {distance_m:.1f} m".lstrip(), _OBSTACLE, 9.0)


def _draw_lines(found: line_points_t | None, lens: _Lens, scene: Scene) -> None:
    scene.layer("lines")
    if found and found.n:
        points_m = np.column_stack((found.x_m, found.y_m, np.zeros(found.n)))
        for x_px, y_px in lens.project(points_m):
            scene.circle(float(x_px), float(y_px), 1.2, fill=_LINE)


def _foot(obstacle: obstacle_t) -> Floats:
    """Returns the circle (n, 3) on which an obstacle stands."""
    angles = np.linspace(0.0, math.tau, _STEPS, endpoint=False)
    x_m = obstacle.x_m + obstacle.radius_m * np.cos(angles)
    y_m = obstacle.y_m + obstacle.radius_m * np.sin(angles)
    return np.column_stack((x_m, y_m, np.zeros(_STEPS)))

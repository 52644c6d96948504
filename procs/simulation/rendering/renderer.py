"""Draws what an omnidirectional camera sees of a robot soccer match."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from procs.model.algebra import Floats, product
from procs.model.field import SIDES, Field
from procs.simulation.rendering.carpet import NEW, Wear, lay_carpet
from procs.simulation.rendering.ground_view import GroundView, half_pixels
from procs.simulation.rendering.shapes import Bodies, markers, pillars
from procs.vision.colours import BLACK, ORANGE, WHITE, Bgr, Picture
from procs.vision.mirror import Mirror

_SHIFT = 4  # fractional bits of OpenCV's drawing coordinates


@dataclass(frozen=True)
class Pose:
    """Pose of a robot in the world frame."""

    x_m: float
    y_m: float
    heading_rad: float


@dataclass(frozen=True)
class Scene:
    """Everything that one picture depends on, world frame."""

    own: Pose
    others: Sequence[tuple[float, float, Bgr]]
    """The other robots: x, y in metres and the colour of the team marker."""
    ball_m: tuple[float, float, float] | None
    """The ball's middle: x, y, height above the ground; None: no ball."""


class Renderer:
    """Renders scenes: the carpet warped to the robot's view, then everything upright from far to near."""

    def __init__(self, mirror: Mirror, field: Field, bodies: Bodies, wear: Wear = NEW) -> None:
        self._mirror = mirror
        self._bodies = bodies
        self._ground = GroundView(mirror, lay_carpet(field, wear=wear))
        self._posts_m = np.array([post for side in SIDES for post in field.goal_posts(side)])
        self._post_size_m = (field.post_diameter_m / 2, field.goal_height_m)
        self._unseen, self._mask = _unseen(mirror.size_px, mirror.radius_px(bodies.robot_radius_m))

    def render(self, scene: Scene, shake_px: tuple[float, float] = (0.0, 0.0)) -> Picture:
        """Returns the picture, size x size x 3, without noise; equal scenes give equal bytes.

        `shake_px` moves everything seen in the mirror by so many columns and rows, at most six, in steps of a half.
        """
        right, down = half_pixels(shake_px)
        own = scene.own
        frame = self._ground.picture(own.x_m, own.y_m, own.heading_rad, right, down)
        self._draw_upright(frame, scene, np.array((right / 2, down / 2)))
        return np.asarray(cv2.copyTo(self._unseen, self._mask, frame), np.uint8)

    def _draw_upright(self, frame: Picture, scene: Scene, shift_px: Floats) -> None:
        own, bodies = scene.own, self._bodies
        robots = np.array([robot[:2] for robot in scene.others]).reshape(-1, 2)
        balls = [] if scene.ball_m is None else [scene.ball_m]
        balls_m = np.array([ball[:2] for ball in balls]).reshape(-1, 2)
        at_m = _seen_from(own, np.vstack([self._posts_m, robots, balls_m]))
        posts, pillared = len(self._posts_m), len(self._posts_m) + len(robots)
        robots_m = at_m[posts:pillared]
        radii_m, heights_m = np.empty((2, pillared))
        radii_m[:posts], heights_m[:posts] = self._post_size_m
        radii_m[posts:], heights_m[posts:] = bodies.robot_radius_m, bodies.robot_height_m
        shapes_m = (
            pillars(at_m[:pillared], radii_m, heights_m),
            markers(robots_m, bodies.robot_radius_m, bodies.marker_m),
        )
        pillars_px, markers_px = self._in_picture(shapes_m, shift_px)
        for i in np.argsort(-np.hypot(at_m[:, 0], at_m[:, 1]), kind="stable").tolist():
            if i >= pillared:
                self._draw_ball(frame, (at_m[i, 0], at_m[i, 1], balls[0][2]), shift_px)
                continue
            cv2.fillConvexPoly(frame, cv2.convexHull(pillars_px[i]), WHITE if i < posts else BLACK, shift=_SHIFT)
            if i >= posts:
                cv2.fillPoly(frame, [markers_px[i - posts]], scene.others[i - posts][2], shift=_SHIFT)

    def _in_picture(self, shapes_m: Sequence[Floats], shift_px: Floats) -> list[cv2.typing.MatLike]:
        """Outlines, each (n, corners, 3), as pixels (n, corners, 2) in OpenCV's fixed-point numbers."""
        pixels = self._mirror.project(np.concatenate([outlines_m.reshape(-1, 3) for outlines_m in shapes_m]))
        pixels = (pixels + shift_px).clip(-4096, 4096)
        found, begin = [], 0
        for outlines_m in shapes_m:
            count, corners = outlines_m.shape[:2]
            outlines = pixels[begin : begin + count * corners].reshape(count, corners, 2)
            begin += count * corners
            # OpenCV paints every pixel that an outline touches, half a pixel too much all around.
            inward = outlines.mean(axis=1, keepdims=True) - outlines
            away_px = np.hypot(inward[..., :1], inward[..., 1:])
            outlines = outlines + inward * (0.5 / np.maximum(away_px, 0.5))
            found.append(np.round(outlines * (1 << _SHIFT)).astype(np.int32))
        return found

    def _draw_ball(self, frame: Picture, centre_m: tuple[float, float, float], shift_px: Floats) -> None:
        column, row, radius_px = self._mirror.sphere(centre_m, self._bodies.ball_radius_m)
        column, row = column + shift_px[0], row + shift_px[1]
        left, top = (max(math.floor(at - radius_px), 0) for at in (column, row))
        right, bottom = (min(math.ceil(at + radius_px) + 1, self._mirror.size_px) for at in (column, row))
        if left >= right or top >= bottom:
            return
        distance_px = np.hypot(np.arange(left, right) - column, (np.arange(top, bottom) - row)[:, None])
        cover = np.clip(radius_px + 0.5 - distance_px, 0.0, 1.0)[..., None]
        window = frame[top:bottom, left:right]
        window[:] = np.round(window * (1.0 - cover) + np.array(ORANGE) * cover)


@lru_cache(maxsize=4)
def _unseen(size_px: int, body_px: float) -> tuple[Picture, NDArray[np.uint8]]:
    """Returns the fixed part of a frame, the robot's own body and black outside the mirror, and its mask.

    All cameras of one size share them, however their mirrors are tilted.
    """
    from_centre_px = np.arange(size_px) - (size_px - 1) / 2
    radius_px = np.hypot(from_centre_px[:, None], from_centre_px)
    bare = (radius_px >= body_px) & (radius_px <= size_px / 2)
    black = np.full((*bare.shape, 3), BLACK, np.uint8)
    return black, np.where(bare, 0, 255).astype(np.uint8)


def _seen_from(own: Pose, points_m: Floats) -> Floats:
    """Points (n, 2) of the world frame in the robot frame."""
    cosine, sine = math.cos(own.heading_rad), math.sin(own.heading_rad)
    return product(points_m - (own.x_m, own.y_m), np.array([[cosine, -sine], [sine, cosine]]))

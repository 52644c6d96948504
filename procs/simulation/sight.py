"""Visible part of the truth for a robot: bodies hide everything behind them."""

import math
from typing import NamedTuple

import numpy as np

from procs.model.algebra import Floats
from procs.model.rays import left_of, rays
from procs.vision.mirror import Mirror
from procs.vision.uncertainty import plane_covariance

_FARTHER_PX = 0.08  # by which robots seem farther away; fitted to rendered pictures
_LEAST_PX = 0.02  # deviation that a percept states at least


def hidden(points_m: Floats, bodies_m: Floats, radius_m: float) -> Floats:
    """Returns which part (0..1) of the way across each point (n) the nearer round bodies (k, 2) leave hidden.

    All places are in the frame of the robot that looks. A point on the ray through a body's middle is hidden wholly,
    one that is a radius beside it is not.
    """
    if not len(points_m):
        return np.zeros(0)
    range_m, ahead = rays(points_m)
    bodies_m = bodies_m[np.hypot(bodies_m[:, 0], bodies_m[:, 1]) < range_m.max()]
    if not len(bodies_m):
        return np.zeros(len(points_m))
    (ahead_x, ahead_y), (x_m, y_m) = ahead.T.copy(), bodies_m.T[:, :, None]  # (body, point)
    along_m, beside_m = ahead_x * x_m + ahead_y * y_m, np.abs(ahead_x * y_m - ahead_y * x_m)
    behind = (along_m > 0) & (along_m < range_m - radius_m)
    cover = np.maximum((radius_m - beside_m) / radius_m, 0.0)
    return np.asarray(np.where(behind, np.minimum(1.0, 2 * cover), 0.0).max(axis=0))


class Glimpse(NamedTuple):
    """Visible part of a ball behind round bodies."""

    visible: float
    """Part (0..1) of its disc."""
    aside_m: float
    """Middle of that part, to the left of the ball's own."""
    one_edge: bool
    """Whether what is hidden lies on one side only, or nothing is hidden."""


def glimpse_of(ball_m: Floats, ball_radius_m: float, bodies_m: Floats, body_radius_m: float) -> Glimpse:
    """Returns the visible part of a ball (2) behind upright bodies (k, 2), in the frame of the robot that looks.

    As in rendered pictures, bodies whose middle is nearer than that of the ball are before it: also that of a robot
    that holds the ball beside or behind itself.
    """
    range_m = max(math.hypot(*ball_m), 1e-6)
    ahead_x, ahead_y = (ball_m / range_m).tolist()
    half_rad = math.asin(min(1.0, ball_radius_m / range_m))
    covered = []  # from right to left, in radii of the ball
    for x_m, y_m in bodies_m.tolist():
        along_m, left_m = ahead_x * x_m + ahead_y * y_m, ahead_x * y_m - ahead_y * x_m
        if along_m > 0.0 and math.hypot(x_m, y_m) < range_m:
            middle_rad = math.atan2(left_m, along_m)
            side_rad = math.asin(min(1.0, body_radius_m / math.hypot(x_m, y_m)))
            covered.append(((middle_rad - side_rad) / half_rad, (middle_rad + side_rad) / half_rad))
    parts, begin = [], -1.0
    for first, last in (*sorted(covered), (1.0, 1.0)):
        end = min(1.0, first)
        if end > begin:
            parts.append((begin, end))
        begin = max(begin, last)
    visible = sum(_disc_area(end) - _disc_area(begin) for begin, end in parts)
    moment = sum(_disc_moment(end) - _disc_moment(begin) for begin, end in parts)
    one_edge = len(parts) == 1 and (parts[0][0] == -1.0 or parts[0][1] == 1.0)
    return Glimpse(visible, ball_radius_m * moment / visible if visible else 0.0, one_edge)


def _disc_area(x: float) -> float:
    """Returns the part of the unit disc's area to the right of a vertical line, between -1 and 1."""
    return 0.5 + (x * math.sqrt(1.0 - x * x) + math.asin(x)) / math.pi


def _disc_moment(x: float) -> float:
    """Returns the mean of the horizontal place over the same part, weighted by its area."""
    return -2.0 / (3.0 * math.pi) * math.pow(1.0 - x * x, 1.5)


def blurred(mirror: Mirror, points_m: Floats, along_px: Floats, across_px: Floats, plane_m: float = 0.0) -> Floats:
    """Returns points (n, 2) in a level plane moved by so many pixels (n) of the mirror's picture, along and across.

    `plane_m` is the height of the plane.
    """
    if not len(points_m):
        return points_m
    range_m, ahead = rays(points_m)
    along_m, across_m = mirror.metres_per_px_each(range_m, plane_m)
    across = left_of(ahead)
    return np.asarray(points_m + ahead * (along_px * along_m)[:, None] + across * (across_px * across_m)[:, None])


def between_rays(
    mirror: Mirror, robots_m: Floats, moved_px: tuple[Floats, Floats], drawn: Floats, radius_m: float, rays_around: int
) -> Floats:
    """Returns where the detector finds robots (n, 2): in the middle of the rays that meet them.

    It knows the near edge on each ray to a pixel and takes the median of the rays.

    Args:
        mirror: the camera.
        robots_m: middles of the robots, robot frame.
        moved_px: pixels (n) by which the robots seem moved, along and across the rays through the middles.
        drawn: (n), standard normal: the errors of the edges.
        radius_m: radius of the robots.
        rays_around: number of rays at equal angles, the first straight ahead.
    """
    range_m, ahead = rays(robots_m)
    half = np.arcsin(np.minimum(1.0, radius_m / range_m)) * rays_around / math.tau  # rays that meet half of a robot
    along_px, across_px = moved_px
    along_px = along_px + (_FARTHER_PX + 0.5 / np.sqrt(2 * half + 2) * drawn)
    near_m = ahead * np.maximum(range_m - radius_m, 1e-6)[:, None]
    edges_m, _ = rays(blurred(mirror, near_m, along_px, across_px))
    _, ahead = rays(blurred(mirror, robots_m, along_px, across_px))
    step_rad = math.tau / rays_around
    middle = np.arctan2(ahead[:, 1], ahead[:, 0]) / step_rad
    angle_rad = (np.ceil(middle - half) + np.floor(middle + half)) / 2 * step_rad
    return np.asarray((edges_m + radius_m)[:, None] * np.column_stack((np.cos(angle_rad), np.sin(angle_rad))))


def displaced(
    mirror: Mirror,
    points_m: Floats,
    shake_px: tuple[float, float],
    tilt_rad: tuple[float, float],
    height_m: float = 0.0,
) -> tuple[Floats, Floats]:
    """Returns the pixels (n) along and across each ray by which a shake and a small tilt move what points (n, 2) show.

    A shake moves everything alike, forward and left. A tilt of the mirror about the robot's x and y axis moves what is
    far away along the ray; a turn about the ray itself hardly moves it. The points are at a height.
    """
    range_m, ahead = rays(points_m)
    forward, left = shake_px
    roll_rad, pitch_rad = tilt_rad
    below_m = mirror.height_m - height_m
    cosine = below_m / np.hypot(range_m, below_m)  # of the angle from straight down
    px_rad = mirror.scale_px / np.maximum(1.0 + cosine, 1e-3)
    ahead_x, ahead_y = ahead.T
    along = (ahead_x * forward + ahead_y * left) + px_rad * (ahead_x * pitch_rad - ahead_y * roll_rad)
    across = (ahead_x * left - ahead_y * forward) - px_rad * cosine * (ahead_x * roll_rad + ahead_y * pitch_rad)
    return along, across


def claimed(
    mirror: Mirror, x_m: float, y_m: float, deviations_px: tuple[float, float], plane_m: float = 0.0
) -> list[list[float]]:
    """Returns the covariance (2, 2) in m² that a percept states; never quite zero. See `plane_covariance`."""
    along_px, across_px = (math.hypot(deviation_px, _LEAST_PX) for deviation_px in deviations_px)
    covariance: list[list[float]] = plane_covariance(mirror, x_m, y_m, (along_px, across_px), plane_m).tolist()
    return covariance

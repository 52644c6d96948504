"""Errors in the world that follow from errors in the picture."""

import math

import numpy as np

from procs.model.algebra import Floats
from procs.vision.mirror import Mirror


def plane_covariance(
    mirror: Mirror, x_m: float, y_m: float, deviations_px: tuple[float, float], plane_m: float = 0.0
) -> Floats:
    """Returns the covariance (2 x 2, robot frame, m²) of a point in the level plane at height `plane_m`.

    `deviations_px` are its standard deviations in the picture, along and across the ray from the picture's centre.
    """
    along_px, across_px = deviations_px
    along_m, across_m = mirror.metres_per_px(math.hypot(x_m, y_m), plane_m)
    return _along_ray(x_m, y_m, along_px * along_m, across_px * across_m)


def sphere_covariance(
    mirror: Mirror, centre_m: tuple[float, float, float], area_share: float, deviation_px: float
) -> Floats:
    """Returns the covariance (2 x 2, robot frame, m²) of the place below a sphere whose size tells its distance.

    Args:
        mirror: the camera.
        centre_m: x, y, z of the sphere's centre, robot frame.
        area_share: relative standard deviation of the area in the picture.
        deviation_px: standard deviation of the centre in the picture.
    """
    x_m, y_m, z_m = centre_m
    range_m, below_m = math.hypot(x_m, y_m), mirror.height_m - z_m
    distance_m = math.hypot(range_m, below_m)
    turn_rad = deviation_px * (1.0 + below_m / distance_m) / mirror.scale_px
    return _along_ray(x_m, y_m, math.hypot(range_m * area_share / 2, turn_rad * below_m), turn_rad * distance_m)


def _along_ray(x_m: float, y_m: float, along_m: float, across_m: float) -> Floats:
    """Returns the covariance (2 x 2) of a point with these deviations along and across the ray to it."""
    distance_m = math.hypot(x_m, y_m)
    ux, uy = (x_m / distance_m, y_m / distance_m) if distance_m > 0 else (1.0, 0.0)
    along_m2, across_m2 = along_m**2, across_m**2
    xx, xy, yy = (
        ux * ux * along_m2 + uy * uy * across_m2,
        ux * uy * (along_m2 - across_m2),
        uy * uy * along_m2 + ux * ux * across_m2,
    )
    return np.array([[xx, xy], [xy, yy]])

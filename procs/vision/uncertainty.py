"""Errors on the ground that follow from errors in the picture."""

import math

import numpy as np

from procs.model.algebra import Floats
from procs.vision.mirror import Mirror


def ground_covariance(
    mirror: Mirror, x_m: float, y_m: float, along_px: float, across_px: float | None = None
) -> Floats:
    """Covariance (2 x 2, robot frame, m²) of a point on the ground.

    `along_px` and `across_px` are its standard deviations in the picture, along and across the ray from the picture's
    centre; without the second both are the same.
    """
    distance_m = math.hypot(x_m, y_m)
    along_m, across_m = mirror.metres_per_px(distance_m)
    along_m *= along_px
    across_m *= along_px if across_px is None else across_px
    ux, uy = (x_m / distance_m, y_m / distance_m) if distance_m > 0 else (1.0, 0.0)
    along_m2, across_m2 = along_m**2, across_m**2
    xx, xy, yy = (
        ux * ux * along_m2 + uy * uy * across_m2,
        ux * uy * (along_m2 - across_m2),
        uy * uy * along_m2 + ux * ux * across_m2,
    )
    return np.array([[xx, xy], [xy, yy]])

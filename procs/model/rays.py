"""Rays from the origin to points on the ground."""

import numpy as np

from procs.model.algebra import Floats

_LEAST_M = 1e-6  # a point at the origin has no direction


def rays(points_m: Floats) -> tuple[Floats, Floats]:
    """Returns the distances (n) of points (n, 2) from the origin, and the unit vectors (n, 2) towards them."""
    ranges_m = np.maximum(np.hypot(points_m[:, 0], points_m[:, 1]), _LEAST_M)
    return ranges_m, points_m / ranges_m[:, None]


def left_of(ahead: Floats) -> Floats:
    """Returns the unit vectors (n, 2) to the left of others (n, 2)."""
    return np.column_stack((-ahead[:, 1], ahead[:, 0]))

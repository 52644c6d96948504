"""Angles and points on the ground."""

import math

from procs.model.field import Point

BOUND = 1e4
"""Measurements are smaller than this in magnitude, in m, rad, m/s and other SI units."""


def wrap_rad(angle_rad: float) -> float:
    """Returns the same angle between -pi and pi."""
    return math.remainder(angle_rad, math.tau)


def clamp(value: float, low: float, high: float) -> float:
    """Returns the value, or the limit that it exceeds."""
    return min(high, max(low, value))


def bearing_rad(start: Point, end: Point) -> float:
    """Returns the direction from one point to another; 0 if they are the same."""
    return math.atan2(end.y_m - start.y_m, end.x_m - start.x_m)


def ahead(start: Point, direction_rad: float, distance_m: float) -> Point:
    """Returns the point at a distance in a direction; a negative distance goes backwards."""
    return Point(start.x_m + distance_m * math.cos(direction_rad), start.y_m + distance_m * math.sin(direction_rad))


def between(start: Point, end: Point, share: float) -> Point:
    """Returns the point of a straight line that lies `share` of the way from start to end."""
    return Point(start.x_m + share * (end.x_m - start.x_m), start.y_m + share * (end.y_m - start.y_m))


def plausible(*values: float) -> bool:
    """Returns whether all values can be measurements; NaN, infinity and values of 10,000 and more cannot."""
    for value in values:  # noqa: SIM110 - `all` and a generator take three times as long
        if not -BOUND < value < BOUND:
            return False
    return True

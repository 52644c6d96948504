"""Outlines of bodies on the field, as points in the robot frame; many bodies of one kind at once."""

import math
from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats
from procs.model.ball import BALL
from procs.model.robot import ROBOT

_MARKER_M = (0.34, 0.50)  # lower and upper edge of the team marker
_CORNERS_RAD = np.linspace(0.0, 2 * math.pi, 20, endpoint=False)
_FRONT_RAD = np.linspace(-1.1, 1.1, 8)  # the part of a round body that can be seen from one side


@dataclass(frozen=True)
class Bodies:
    """Sizes of robots and ball, metres."""

    robot_radius_m: float = ROBOT.radius_m
    robot_height_m: float = ROBOT.height_m
    ball_radius_m: float = BALL.radius_m


def pillars(at_m: Floats, radius_m: float, height_m: float) -> Floats:
    """Returns the rims (n, corners, 3) of round upright bodies at points (n, 2); their hull is the visible shape."""
    rims = at_m[:, None] + radius_m * np.column_stack((np.cos(_CORNERS_RAD), np.sin(_CORNERS_RAD)))
    return np.concatenate((_at_height(rims, 0.0), _at_height(rims, height_m)), axis=1)


def markers(at_m: Floats, radius_m: float) -> Floats:
    """Outlines of the team markers on round bodies at points (n, 2), as seen from the origin: (n, corners, 3)."""
    angles = np.arctan2(-at_m[:, 1], -at_m[:, 0])[:, None] + _FRONT_RAD
    fronts = at_m[:, None] + radius_m * np.stack((np.cos(angles), np.sin(angles)), axis=2)
    return np.concatenate((_at_height(fronts, _MARKER_M[0]), _at_height(fronts[:, ::-1], _MARKER_M[1])), axis=1)


def _at_height(points_m: Floats, height_m: float) -> Floats:
    return np.concatenate((points_m, np.full((*points_m.shape[:2], 1), height_m)), axis=2)

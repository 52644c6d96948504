"""Outlines of bodies on the field, as points in the robot frame; many bodies of one kind at once."""

import math
from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats
from procs.model.ball import BALL, BallModel
from procs.model.robot import ROBOT, RobotModel

_RIM = np.array([(math.cos(at), math.sin(at)) for at in np.linspace(0.0, 2 * math.pi, 20, endpoint=False)])
_FRONT_RAD = np.linspace(-1.1, 1.1, 8)  # the part of a round body that can be seen from one side


@dataclass(frozen=True)
class Bodies:
    """Sizes of robots and ball, metres."""

    robot_radius_m: float = ROBOT.radius_m
    robot_height_m: float = ROBOT.height_m
    marker_m: tuple[float, float] = ROBOT.marker_m
    """Heights of the lower and the upper edge of the team marker."""
    ball_radius_m: float = BALL.radius_m

    @classmethod
    def of(cls, robot: RobotModel, ball: BallModel) -> "Bodies":
        """Returns the sizes of these models."""
        return cls(robot.radius_m, robot.height_m, robot.marker_m, ball.radius_m)


def pillars(at_m: Floats, radii_m: Floats, heights_m: Floats) -> Floats:
    """Returns the rims (n, corners, 3) of round upright bodies at points (n, 2); their hull is the visible shape.

    `radii_m` and `heights_m` are (n).
    """
    outlines_m = np.zeros((len(at_m), 2 * len(_RIM), 3))
    lower, upper = outlines_m[:, : len(_RIM)], outlines_m[:, len(_RIM) :]
    lower[..., :2] = upper[..., :2] = at_m[:, None] + radii_m[:, None, None] * _RIM
    upper[..., 2] = heights_m[:, None]
    return outlines_m


def markers(at_m: Floats, radius_m: float, edges_m: tuple[float, float]) -> Floats:
    """Outlines of the team markers on round bodies at points (n, 2), as seen from the origin: (n, corners, 3)."""
    angles = np.arctan2(-at_m[:, 1], -at_m[:, 0])[:, None] + _FRONT_RAD
    outlines_m = np.empty((len(at_m), 2 * len(_FRONT_RAD), 3))
    lower, upper = outlines_m[:, : len(_FRONT_RAD)], outlines_m[:, len(_FRONT_RAD) :]
    lower[..., :2] = at_m[:, None] + radius_m * np.stack((np.cos(angles), np.sin(angles)), axis=2)
    upper[..., :2] = lower[:, ::-1, :2]
    lower[..., 2], upper[..., 2] = edges_m
    return outlines_m

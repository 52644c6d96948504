"""Places of robots before the kick-off, and places for the ball that are free of robots."""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from procs.model.field import Field, Point
from procs.model.robot import Player, side_of


class Pose(NamedTuple):
    """Place and heading in the world frame."""

    x_m: float
    y_m: float
    heading_rad: float


_PLACES = {1: (0.95, 0.0), 2: (0.3, 0.0), 3: (0.45, -0.4), 4: (0.45, 0.4), 5: (0.65, 0.0)}
"""By number: distance from the halfway line and offset to the left, as shares of half the length and half the width."""


def three_numbers(pose: Any) -> Any:
    """Returns the pose of a file if it is a list of three values, before these are checked.

    Raises:
        ValueError: it is anything else.
    """
    if isinstance(pose, list | tuple) and len(pose) == 3:
        return pose
    raise ValueError("it should be the numbers x_m, y_m and heading_rad, such as [-1.0, 0.5, 0.0]")


def starting_pose(player: Player | None, field: Field) -> Pose:
    """Returns a place in the own half, facing the other goal: number 1 in the goal, high numbers at the touch line.

    A robot that is not a player stands at cyan's touch line.
    """
    number = player.number if player else 0
    depth, offset = _PLACES.get(number, (0.9 - 0.1 * (number % 9), -0.85))
    side = side_of(player.team if player else "")
    heading_rad = math.pi if side > 0 else 0.0
    return Pose(side * depth * field.half_length_m, -side * offset * field.half_width_m, heading_rad)


def free_place(wanted: Point, robots: Iterable[Point], clearance_m: float) -> Point:
    """Returns the free place nearest to the wanted one, with `clearance_m` to the middle of every robot.

    Each robot in the way pushes the place straight away from itself, a few rounds long; between robots that leave no
    room the place may stay too close.
    """
    middles = list(robots)
    x_m, y_m = wanted
    for _ in range(8):
        near = [robot for robot in middles if math.dist((x_m, y_m), robot) < clearance_m - 1e-9]
        if not near:
            break
        robot = min(near, key=lambda middle: (math.dist((x_m, y_m), middle), middle))
        distance_m = math.dist((x_m, y_m), robot)
        away_x, away_y = ((x_m - robot.x_m) / distance_m, (y_m - robot.y_m) / distance_m) if distance_m else (0.0, 1.0)
        x_m, y_m = robot.x_m + away_x * clearance_m, robot.y_m + away_y * clearance_m
    return Point(x_m, y_m)

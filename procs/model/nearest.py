"""Keeps the nearest of many things: processing more than a robot can have seen would take longer than a tick."""

import math
from collections.abc import Sequence
from typing import Protocol, TypeVar

from procs.model.geometry import plausible


class Placed(Protocol):
    """Thing at a place in the robot frame."""

    x_m: float
    y_m: float


T = TypeVar("T", bound=Placed)


def nearest(things: Sequence[T], most: int) -> list[T]:
    """Returns the things with a plausible place, in their order; of more than `most` those nearest to the robot."""
    placed = [each for each in things if plausible(each.x_m, each.y_m)]
    if len(placed) <= most:
        return placed
    by_distance = sorted(range(len(placed)), key=lambda index: math.hypot(placed[index].x_m, placed[index].y_m))
    return [placed[index] for index in sorted(by_distance[:most])]

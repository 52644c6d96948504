"""One sighting of the ball, as its track judges it."""

import math
from dataclasses import dataclass

import numpy as np

from procs.model.frames import Floats

_OWN_BONUS = 4.0  # factor by which a sighting of the own camera outranks a mate's of the same variance
_SAME_RAY_M = 0.3  # largest distance from the ray of a sighting at which a ball may be the thing seen
_SEEMS_FURTHER = 0.06  # share of its distance by which a low flying ball that seems to lie appears too far away


@dataclass(frozen=True)
class Sighting:
    """Position of the ball as a robot saw it: world frame, captured `age_s` ago."""

    robot: str
    own: bool
    """Whether the own camera saw it, not that of a mate."""
    position_m: Floats
    """(2)."""
    covariance_m2: Floats
    """(2, 2) of the position."""
    age_s: float = 0.0
    height_m: float = 0.0
    """Height of the ball's lowest point; 0 for a ball that seems to lie on the ground."""
    observer_m: Floats | None = None
    """(2): place of the robot, if it is known."""

    def of_flying_m2(self) -> Floats:
        """Returns the covariance (2, 2) of the place of a ball that flies, perhaps so low that it seems to lie."""
        if self.height_m > 0.0 or self.observer_m is None:
            return self.covariance_m2
        too_far_m = _SEEMS_FURTHER * (self.position_m - self.observer_m)
        return self.covariance_m2 + np.outer(too_far_m, too_far_m)

    def may_be_nearer(self, place_m: tuple[float, float]) -> bool:
        """Returns whether the ball that seems to lie here may be one in the air, nearer on the same ray.

        A flying ball that a robot partly hides looks as large as a ball on the ground behind it.
        """
        if self.height_m > 0.0 or self.observer_m is None:
            return False
        seems_x_m, seems_y_m = (self.position_m - self.observer_m).tolist()
        is_x_m, is_y_m = (place_m - self.observer_m).tolist()
        distance_m, along_m2 = math.hypot(seems_x_m, seems_y_m), seems_x_m * is_x_m + seems_y_m * is_y_m
        across_m2 = abs(seems_x_m * is_y_m - seems_y_m * is_x_m)
        return bool(0.0 < along_m2 < distance_m**2 and across_m2 < _SAME_RAY_M * distance_m)

    @property
    def weakness(self) -> float:
        """Rank of the source; a smaller one is better."""
        return float(self.covariance_m2[0, 0] + self.covariance_m2[1, 1]) / (_OWN_BONUS if self.own else 1.0)

"""Things that a robot saw in one frame, with their covariances."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from procs.model.covariance import is_covariance
from procs.model.frames import Flags, Floats
from procs.model.geometry import plausible

MOST_OBSTACLES = 50
"""Most obstacles of a frame that count: more cannot all be robots, and would take too much time of a tick."""
_LEAST_M2 = 1e-6  # added to the variances of a sighting: a millimetre squared, which keeps filters regular


@dataclass(frozen=True)
class Seen:
    """n things in one frame of reference: positions (n, 2) in m, covariances (n, 2, 2) in m² in two parts.

    The first part comes from the sight itself and is independent in each picture; the second comes from the observer's
    pose.
    """

    NOTHING: ClassVar["Seen"]

    positions_m: Floats
    by_sight_m2: Floats
    by_pose_m2: Floats
    radii_m: Floats
    """(n): of obstacles."""

    @classmethod
    def of(cls, positions_m: Iterable[Any], covariances_m2: Iterable[Any], radii_m: Iterable[float]) -> "Seen":
        """Returns things with covariances of the sight only; leaves out those with impossible values.

        Args:
            positions_m: n pairs x, y.
            covariances_m2: n matrices (2, 2).
            radii_m: n radii.
        """
        rows = []
        for (x_m, y_m), ((xx_m2, xy_m2), (yx_m2, yy_m2)), radius_m in zip(
            positions_m, covariances_m2, radii_m, strict=True
        ):
            if plausible(x_m, y_m, radius_m) and is_covariance(((xx_m2, xy_m2), (yx_m2, yy_m2))):
                rows.append((x_m, y_m, xx_m2 + _LEAST_M2, xy_m2, yx_m2, yy_m2 + _LEAST_M2, radius_m))
        if not rows:
            return cls.NOTHING
        values = np.array(rows, np.float64)
        return cls(values[:, :2], values[:, 2:6].reshape(-1, 2, 2), np.zeros((len(values), 2, 2)), values[:, 6])

    @cached_property
    def covariances_m2(self) -> Floats:
        """(n, 2, 2) of a single sighting."""
        return self.by_sight_m2 + self.by_pose_m2

    def only(self, which: Flags) -> "Seen":
        """Returns those with a true flag (n)."""
        return Seen(self.positions_m[which], self.by_sight_m2[which], self.by_pose_m2[which], self.radii_m[which])

    def widened(self, sight: float, pose: float) -> "Seen":
        """Returns the same with wider covariances, for filters that assume independent errors of all frames.

        `sight` and `pose` are the numbers of frames that share one error of the sight and of the observer's pose.
        """
        if sight == pose == 1.0:
            return self
        return Seen(self.positions_m, self.by_sight_m2 * sight, self.by_pose_m2 * pose, self.radii_m)


Seen.NOTHING = Seen(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros((0, 2, 2)), np.zeros(0))

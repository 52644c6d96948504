"""Things that a robot saw in one frame, with their covariances."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from procs.model.frames import BOUND, Flags, Floats

_LEAST_M2 = 1e-6  # a millimetre: least variance of a sighting, which keeps filters regular


@dataclass(frozen=True)
class Seen:
    """n things in one frame of reference: positions (n, 2) in m, covariances (n, 2, 2) in m² in two parts.

    The first part comes from the sight itself and is new in each picture; the second from the observer's pose.
    """

    NOTHING: ClassVar["Seen"]

    positions_m: Floats
    by_sight_m2: Floats
    by_pose_m2: Floats
    radii_m: Floats
    """(n): of obstacles."""

    @classmethod
    def of(cls, positions_m: ArrayLike, covariances_m2: ArrayLike, radii_m: ArrayLike) -> "Seen":
        """Returns things with the covariance of the sight, without those that have impossible values."""
        places = np.asarray(positions_m, dtype=np.float64).reshape(-1, 2)
        spreads = np.asarray(covariances_m2, dtype=np.float64).reshape(-1, 2, 2)
        sizes = np.asarray(radii_m, dtype=np.float64)
        values = np.hstack((places, spreads.reshape(-1, 4), sizes[:, None]))
        sound = (np.abs(values) < BOUND).all(axis=1)  # false for NaN too
        places, spreads, sizes = places[sound], spreads[sound] + np.eye(2) * _LEAST_M2, sizes[sound]
        across = spreads[:, 0, 1] * spreads[:, 1, 0]
        proper = (spreads[:, 0, 0] > 0) & (spreads[:, 1, 1] > 0) & (spreads[:, 0, 0] * spreads[:, 1, 1] > across)
        return cls(places[proper], spreads[proper], np.zeros((int(proper.sum()), 2, 2)), sizes[proper])

    @property
    def covariances_m2(self) -> Floats:
        """(n, 2, 2) of a single sighting."""
        return self.by_sight_m2 + self.by_pose_m2

    def only(self, which: Flags) -> "Seen":
        """Returns those with a true flag (n)."""
        return Seen(self.positions_m[which], self.by_sight_m2[which], self.by_pose_m2[which], self.radii_m[which])

    def widened(self, sight: float, pose: float) -> "Seen":
        """Returns the same with wider covariances, for filters that take the errors of all frames for independent.

        `sight` and `pose` are the numbers of frames that share one error of the sight and of the own pose.
        """
        return Seen(self.positions_m, self.by_sight_m2 * sight, self.by_pose_m2 * pose, self.radii_m)


Seen.NOTHING = Seen(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros((0, 2, 2)), np.zeros(0))

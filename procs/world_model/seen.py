"""Things that a robot saw in one frame: where, and how surely."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from procs.model.frames import BOUND, Flags, Floats

_LEAST_M2 = 1e-6  # nobody sees better than to a millimetre; it keeps filters regular


@dataclass(frozen=True)
class Seen:
    """n things in one frame of reference: positions (n, 2) in m, covariances (n, 2, 2) in m² in two parts.

    The first part comes from the sight itself and is new in each picture; the second from the pose of who saw it.
    """

    NOTHING: ClassVar["Seen"]

    positions_m: Floats
    by_sight_m2: Floats
    by_pose_m2: Floats
    radii_m: Floats
    """(n): of obstacles."""

    @classmethod
    def of(cls, positions_m: ArrayLike, covariances_m2: ArrayLike, radii_m: ArrayLike) -> "Seen":
        """Things with the covariance of the sight; those with values that cannot be are left out."""
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
        """Some of them."""
        return Seen(self.positions_m[which], self.by_sight_m2[which], self.by_pose_m2[which], self.radii_m[which])

    def widened(self, sight: float, pose: float, moved_m: float = 0.0) -> "Seen":
        """For a filter that takes every frame for new, though errors last several frames: so many each.

        What moves may also have gone `moved_m` since it was seen.
        """
        by_sight_m2 = self.by_sight_m2 * sight + np.eye(2) * moved_m**2
        return Seen(self.positions_m, by_sight_m2, self.by_pose_m2 * pose, self.radii_m)


Seen.NOTHING = Seen(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros((0, 2, 2)), np.zeros(0))

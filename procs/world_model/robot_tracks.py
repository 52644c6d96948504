"""Follows the robots that are seen as obstacles: one Kalman filter each, all of them computed together."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from procs.model.frames import Flags, Floats, Indices

_ACCELERATION_M_S2 = 2.5
_UNKNOWN_SPEED_M_S = 1.5
_GATE = 9.2  # chi-square, 2 degrees of freedom, 99 %
_FARTHEST_M = 1.5
_SAME_M = 0.45  # robots are 0.5 m wide


class RobotTracks:
    """n tracks of position and velocity in the world frame."""

    def __init__(self) -> None:
        self.states = np.zeros((0, 4))
        """(n, 4): x, y (m), vx, vy (m/s)."""
        self.covariances = np.zeros((0, 4, 4))
        self.ages_s = np.zeros(0)
        """Since each was last seen."""
        self.sightings = np.zeros(0, dtype=np.int64)

    @property
    def sure(self) -> Indices:
        """Indices of the tracks that were seen more than once; a single sighting may be a ghost."""
        return np.flatnonzero(self.sightings > 1)

    def predict(self, duration_s: float, timeout_s: float) -> None:
        """Lets everybody move on; a track that nobody confirmed for the time-out ends."""
        self.ages_s = self.ages_s + duration_s
        self._keep(self.ages_s <= np.where(self.sightings > 1, timeout_s, timeout_s / 4))
        motion = np.eye(4)
        motion[0, 2] = motion[1, 3] = duration_s
        push = np.array((duration_s**2 / 2, duration_s))
        noise = np.kron(np.outer(push, push), np.eye(2)) * _ACCELERATION_M_S2**2
        self.states = self.states @ motion.T
        self.covariances = motion @ self.covariances @ motion.T + noise

    def see(self, positions_m: Floats, covariances_m2: Floats) -> None:
        """One robot's sightings of a frame: positions (m, 2) and covariances (m, 2, 2); each is another robot."""
        free = np.ones(len(positions_m), dtype=bool)
        if len(self.states) and len(positions_m):
            innovations = positions_m[None] - self.states[:, None, :2]
            spreads = self.covariances[:, None, :2, :2] + covariances_m2[None]
            surprises = np.einsum("nmi,nmi->nm", innovations, np.linalg.solve(spreads, innovations[..., None])[..., 0])
            near = (surprises <= _GATE) & (np.hypot(innovations[..., 0], innovations[..., 1]) <= _FARTHEST_M)
            tracks, seen = linear_sum_assignment(np.where(near, surprises, 1e3))
            fits = near[tracks, seen]
            tracks, seen = tracks[fits], seen[fits]
            self._correct(tracks, innovations[tracks, seen], spreads[tracks, seen])
            free[seen] = False
        self._begin(positions_m[free], covariances_m2[free])
        self._join()

    def _correct(self, tracks: Indices, innovations: Floats, spreads: Floats) -> None:
        covariances = self.covariances[tracks]
        gains = np.linalg.solve(spreads, covariances[:, :2]).transpose(0, 2, 1)
        self.states[tracks] += (gains @ innovations[..., None])[..., 0]
        corrected = covariances - gains @ covariances[:, :2]
        self.covariances[tracks] = (corrected + corrected.transpose(0, 2, 1)) / 2
        self.ages_s[tracks] = 0.0
        self.sightings[tracks] += 1

    def _begin(self, positions_m: Floats, covariances_m2: Floats) -> None:
        count = len(positions_m)
        if not count:
            return
        covariances = np.tile(np.eye(4) * _UNKNOWN_SPEED_M_S**2, (count, 1, 1))
        covariances[:, :2, :2] = covariances_m2
        self.states = np.vstack((self.states, np.hstack((positions_m, np.zeros((count, 2))))))
        self.covariances = np.concatenate((self.covariances, covariances))
        self.ages_s = np.append(self.ages_s, np.zeros(count))
        self.sightings = np.append(self.sightings, np.ones(count, dtype=np.int64))

    def _join(self) -> None:
        """Two tracks in one place are one robot; the one that was seen more often stays, of equals the older."""
        apart_m = np.hypot(*(self.states[:, None, :2] - self.states[None, :, :2]).transpose(2, 0, 1))
        number = np.arange(len(self.states))
        more = (self.sightings[None] > self.sightings[:, None]) | (
            (self.sightings[None] == self.sightings[:, None]) & (number[None] < number[:, None])
        )
        self._keep(~((apart_m < _SAME_M) & more).any(axis=1))

    def _keep(self, which: Flags) -> None:
        if not which.all():
            self.states, self.covariances = self.states[which], self.covariances[which]
            self.ages_s, self.sightings = self.ages_s[which], self.sightings[which]


def without_known(
    positions_m: Floats, covariances_m2: Floats, known_m: Floats, known_m2: Floats, within_m: float
) -> Flags:
    """Which (m) of the sightings remain when each known robot (k, 2) takes away the one that it is.

    A robot takes away one at most, so that an opponent beside a team mate stays. It is the one that fits best by
    the covariances of sightings (m, 2, 2) and known robots (k, 2, 2); two robots that are seen by their near sides only
    and at different times count as the same up to `within_m`, whatever the covariances say.
    """
    remain = np.ones(len(positions_m), dtype=bool)
    if len(positions_m) and len(known_m):
        offsets_m = positions_m[None] - known_m[:, None]
        spreads = covariances_m2[None] + known_m2[:, None] + np.eye(2) * (within_m / 3) ** 2
        surprises = np.einsum("kmi,kmi->km", offsets_m, np.linalg.solve(spreads, offsets_m[..., None])[..., 0])
        near = surprises <= _GATE
        known, seen = linear_sum_assignment(np.where(near, surprises, 1e3))
        remain[seen[near[known, seen]]] = False
    return remain

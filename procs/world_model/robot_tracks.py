"""Tracks of the robots that are seen as obstacles: a Kalman filter for each, all in one batch."""

from functools import lru_cache

import numpy as np

from procs.model.estimation import linear_sum_assignment
from procs.model.frames import Flags, Floats, Indices
from procs.world_model.batch import corrected, drift, innovation, inverted

_NOISE_M2_S3 = 1.25  # spectral density of the acceleration: robots change their velocity by 1.1 m/s in a second
_UNKNOWN_SPEED_M_S = 1.5
_GATE = 9.2  # chi-square, 2 degrees of freedom, 99 %
_FARTHEST_M = 1.5
_SAME_M = 0.45  # robots are 0.5 m wide
_AXES = np.arange(4)


class RobotTracks:
    """n tracks of position and velocity in the world frame."""

    def __init__(self) -> None:
        self.states: Floats = np.zeros((0, 4))
        """(n, 4): x, y (m), vx, vy (m/s)."""
        self.covariances: Floats = np.zeros((0, 4, 4))
        """(n, 4, 4) of the states."""
        self.ages_s: Floats = np.zeros(0)
        """(n): time since each robot was last seen."""
        self._sightings: Indices = np.zeros(0, np.intp)

    def __len__(self) -> int:
        return len(self.states)

    @property
    def sure(self) -> Indices:
        """Indices of the tracks with more than one sighting; a single sighting may be a ghost."""
        return np.flatnonzero(self._sightings > 1)

    def predict(self, duration_s: float, timeout_s: float) -> None:
        """Moves all tracks on by `duration_s`; drops those without a sighting for `timeout_s`."""
        self.ages_s = self.ages_s + duration_s
        current = self.ages_s <= np.where(self._sightings > 1, timeout_s, timeout_s / 4)
        if not current.all():
            self._keep(current)
        self.states[:, :2] += duration_s * self.states[:, 2:]
        drift(self.covariances, duration_s)
        self.covariances += _noise(duration_s)

    def see(self, positions_m: Floats, covariances_m2: Floats, age_s: float = 0.0) -> None:
        """Takes one robot's sightings of a frame, captured `age_s` ago, each of a different robot.

        Args:
            positions_m: (m, 2), world frame.
            covariances_m2: (m, 2, 2).
            age_s: time since the exposure.
        """
        if not len(positions_m):
            return
        tracks, seen = self._assign(positions_m, covariances_m2, age_s)
        if len(tracks):
            before = self.states[tracks], self.covariances[tracks]
            found = innovation(*before, positions_m[seen], covariances_m2[seen], age_s)
            self.states[tracks], self.covariances[tracks] = corrected(*before, found)
            self.ages_s[tracks] = np.minimum(self.ages_s[tracks], age_s)
            self._sightings[tracks] += 1
        if len(seen) < len(positions_m):
            free = np.ones(len(positions_m), dtype=bool)
            free[seen] = False
            self._begin(positions_m[free], covariances_m2[free], age_s)
        self._join()

    def _assign(self, positions_m: Floats, covariances_m2: Floats, age_s: float) -> tuple[Indices, Indices]:
        """Returns the tracks that are seen, and the sighting of each."""
        if not len(self):
            return np.zeros(0, np.intp), np.zeros(0, np.intp)
        predicted_m = self.states[:, :2] - age_s * self.states[:, 2:]
        gains = self.covariances[:, :2] - age_s * self.covariances[:, 2:]
        spreads = gains[:, :, :2] - age_s * gains[:, :, 2:]
        apart_m = positions_m[None] - predicted_m[:, None]
        surprises = _surprises(apart_m, spreads[:, None] + covariances_m2[None])
        near = (surprises <= _GATE) & ((apart_m**2).sum(axis=2) <= _FARTHEST_M**2)
        rows, columns = linear_sum_assignment(np.where(near, surprises, 1e3))
        fits = near[rows, columns]
        return rows[fits], columns[fits]

    def _begin(self, positions_m: Floats, covariances_m2: Floats, age_s: float) -> None:
        count = len(positions_m)
        states, covariances = np.zeros((count, 4)), np.zeros((count, 4, 4))
        states[:, :2], covariances[:, :2, :2] = positions_m, covariances_m2
        covariances[:, _AXES, _AXES] += _UNKNOWN_SPEED_M_S**2 * np.array((age_s**2, age_s**2, 1.0, 1.0))
        self.states = np.concatenate((self.states, states))
        self.covariances = np.concatenate((self.covariances, covariances))
        self.ages_s = np.concatenate((self.ages_s, np.full(count, age_s)))
        self._sightings = np.concatenate((self._sightings, np.ones(count, np.intp)))

    def _join(self) -> None:
        """Drops the less seen of two tracks in one place; of equals, the younger."""
        if len(self) < 2:
            return
        apart_m = self.states[:, None, :2] - self.states[None, :, :2]
        same = (apart_m**2).sum(axis=2) < _SAME_M**2
        if np.count_nonzero(same) == len(self):
            return
        kept = np.zeros(len(self), dtype=bool)
        for track in np.argsort(-self._sightings, kind="stable"):
            kept[track] = not (same[track] & kept).any()
        self._keep(kept)

    def _keep(self, which: Flags) -> None:
        self.states, self.covariances = self.states[which], self.covariances[which]
        self.ages_s, self._sightings = self.ages_s[which], self._sightings[which]


def without_known(
    positions_m: Floats, covariances_m2: Floats, known_m: Floats, known_m2: Floats, within_m: float
) -> Flags:
    """Flags (m) of the sightings that remain when each known robot takes away the one that it is.

    A known robot takes away one sighting at most, so that an opponent beside a mate stays. Robots are seen by their
    near sides only and at different times, so a sighting within `within_m` of a known robot is that robot whatever
    the covariances say.

    Args:
        positions_m: (m, 2) of the sightings, world frame.
        covariances_m2: (m, 2, 2) of the sightings.
        known_m: (k, 2) of the known robots.
        known_m2: (k, 2, 2) of the known robots.
        within_m: distance between a known robot and its sighting.
    """
    remain = np.ones(len(positions_m), dtype=bool)
    if len(positions_m) and len(known_m):
        spreads = covariances_m2[None] + known_m2[:, None] + np.eye(2) * (within_m / 3) ** 2
        surprises = _surprises(positions_m[None] - known_m[:, None], spreads)
        near = surprises <= _GATE
        known, seen = linear_sum_assignment(np.where(near, surprises, 1e3))
        remain[seen[near[known, seen]]] = False
    return remain


@lru_cache(maxsize=32)
def _noise(duration_s: float) -> Floats:
    """Returns the process noise (4, 4) of a robot that accelerates at random; cached."""
    noise = np.zeros((4, 4))
    place, both, velocity = _NOISE_M2_S3 * np.array((duration_s**3 / 3, duration_s**2 / 2, duration_s))
    noise[_AXES, _AXES] = place, place, velocity, velocity
    noise[0, 2] = noise[2, 0] = noise[1, 3] = noise[3, 1] = both
    return noise


def _surprises(innovations: Floats, spreads: Floats) -> Floats:
    """Returns squared Mahalanobis distances (n, m) of innovations (n, m, 2) with covariances (n, m, 2, 2)."""
    weighted = (inverted(spreads)[0] @ innovations[..., None])[..., 0]
    return np.asarray((innovations * weighted).sum(axis=-1))

"""Tracks of the robots that are seen as obstacles: a Kalman filter for each."""

import math

import numpy as np

from procs.model.estimation import linear_sum_assignment, predict, update
from procs.model.frames import Flags, Floats, Indices

_ACCELERATION_M_S2 = 2.5
_UNKNOWN_SPEED_M_S = 1.5
_GATE = 9.2  # chi-square, 2 degrees of freedom, 99 %
_FARTHEST_M = 1.5
_SAME_M = 0.45  # robots are 0.5 m wide


class _Track:
    """Position and velocity of one robot: state x, y (m), vx, vy (m/s)."""

    def __init__(self, position_m: Floats, covariance_m2: Floats, age_s: float) -> None:
        self.state = np.concatenate((position_m, (0.0, 0.0)))
        self.covariance = np.eye(4) * _UNKNOWN_SPEED_M_S**2
        self.covariance[:2, :2] = covariance_m2 + np.eye(2) * (_UNKNOWN_SPEED_M_S * age_s) ** 2
        self.age_s = age_s
        self.sightings = 1

    @property
    def place(self) -> tuple[float, float]:
        return float(self.state[0]), float(self.state[1])

    def move(self, motion: Floats, noise: Floats) -> None:
        self.state, self.covariance = predict(self.state, self.covariance, F=motion, Q=noise)

    def see(self, position_m: Floats, covariance_m2: Floats, seen_as: Floats) -> None:
        self.state, self.covariance = update(self.state, self.covariance, position_m, covariance_m2, H=seen_as)
        self.sightings += 1


class RobotTracks:
    """n tracks of position and velocity in the world frame."""

    def __init__(self) -> None:
        self._tracks: list[_Track] = []

    def __len__(self) -> int:
        return len(self._tracks)

    @property
    def states(self) -> Floats:
        """(n, 4): x, y (m), vx, vy (m/s)."""
        return np.array([track.state for track in self._tracks]).reshape(-1, 4)

    @property
    def covariances(self) -> Floats:
        """(n, 4, 4) of the states."""
        return np.array([track.covariance for track in self._tracks]).reshape(-1, 4, 4)

    @property
    def ages_s(self) -> Floats:
        """(n): time since each robot was last seen."""
        return np.array([track.age_s for track in self._tracks])

    @property
    def sure(self) -> Indices:
        """Indices of the tracks with more than one sighting; a single sighting may be a ghost."""
        return np.flatnonzero([track.sightings > 1 for track in self._tracks])

    def predict(self, duration_s: float, timeout_s: float) -> None:
        """Moves all tracks on by `duration_s`; drops those without a sighting for `timeout_s`."""
        motion, noise = _motion(duration_s)
        for track in self._tracks:
            track.age_s += duration_s
            track.move(motion, noise)
        self._tracks = [
            track for track in self._tracks if track.age_s <= (timeout_s if track.sightings > 1 else timeout_s / 4)
        ]

    def see(self, positions_m: Floats, covariances_m2: Floats, age_s: float = 0.0) -> None:
        """Takes one robot's sightings of a frame, captured `age_s` ago, each of a different robot.

        Args:
            positions_m: (m, 2), world frame.
            covariances_m2: (m, 2, 2).
            age_s: time since the exposure.
        """
        free = np.ones(len(positions_m), dtype=bool)
        seen_as = _seen_as(age_s)
        if self._tracks and len(positions_m):
            predicted = np.array([seen_as @ track.state for track in self._tracks])
            spread = np.array([seen_as @ track.covariance @ seen_as.T for track in self._tracks])
            innovations = positions_m[None] - predicted[:, None]
            surprises = _surprises(innovations, spread[:, None] + covariances_m2[None])
            near = (surprises <= _GATE) & (np.hypot(innovations[..., 0], innovations[..., 1]) <= _FARTHEST_M)
            rows, columns = linear_sum_assignment(np.where(near, surprises, 1e3))
            for row, column in zip(rows[near[rows, columns]], columns[near[rows, columns]], strict=True):
                track = self._tracks[row]
                track.see(positions_m[column], covariances_m2[column], seen_as)
                track.age_s = min(track.age_s, age_s)
                free[column] = False
        for position_m, covariance_m2 in zip(positions_m[free], covariances_m2[free], strict=True):
            self._tracks.append(_Track(position_m, covariance_m2, age_s))
        self._join()

    def _join(self) -> None:
        """Drops the less seen of two tracks in one place; of equals, the younger."""
        kept: list[_Track] = []
        for track in sorted(self._tracks, key=lambda each: -each.sightings):
            if all(math.dist(track.place, other.place) >= _SAME_M for other in kept):
                kept.append(track)
        self._tracks = [track for track in self._tracks if track in kept]


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


def _motion(duration_s: float) -> tuple[Floats, Floats]:
    """Transition matrix (4, 4) and process noise (4, 4) of a robot that accelerates at random."""
    motion = np.eye(4)
    motion[0, 2] = motion[1, 3] = duration_s
    push = np.array((duration_s**2 / 2, duration_s))
    noise = np.kron(np.outer(push, push), np.eye(2)) * _ACCELERATION_M_S2**2
    return motion, np.asarray(noise, np.float64)


def _seen_as(age_s: float) -> Floats:
    """Measurement matrix (2, 4) of a position that was seen `age_s` ago."""
    return np.array(((1.0, 0.0, -age_s, 0.0), (0.0, 1.0, 0.0, -age_s)))


def _surprises(innovations: Floats, spreads: Floats) -> Floats:
    """Squared Mahalanobis distances (n, m) of innovations (n, m, 2) with covariances (n, m, 2, 2)."""
    weighted = np.linalg.solve(spreads, innovations[..., None])[..., 0]
    return np.asarray((innovations * weighted).sum(axis=-1))

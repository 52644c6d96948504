"""Tracks of the robots that are seen as obstacles: one Kalman filter each, all in one batch.

The acceleration of a robot lasts for a while (Singer, 1970), so it is a state of the filter. Without it, tracks would
lag behind robots that start and run ahead of robots that brake.
"""

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np

from procs.model.estimation import linear_sum_assignment
from procs.model.frames import Flags, Floats, Indices
from procs.model.robot import ROBOT
from procs.world_model.batch import Innovation, corrected, innovation_of, inverted, places_at, seen_at
from procs.world_model.contact import RobotRow
from procs.world_model.team import PlaceRow

_STATES = 6
_ACCELERATION_M_S2 = 3.0  # deviation of a robot's acceleration along an axis
_LASTS_S = 0.35  # time constant of an acceleration
_NOISE_M2_S3 = 0.1  # spectral density of accelerations that do not last
_UNKNOWN_SPEED_M_S = 1.5  # deviation of an unknown velocity along an axis
_GATE = 9.2  # chi-square, 2 degrees of freedom, 99 %
_FARTHEST_M = 1.5  # largest distance between a track and its sighting
_NO_PAIR = 1e3  # cost of a pair that does not fit, above all costs of pairs that fit
_SAME = 0.9  # as a share of the width of a robot; the middles of two robots are further apart
_AXES = np.arange(_STATES)
_NONE: Indices = np.zeros(0, np.intp)


class RobotTracks:
    """n tracks of position and velocity in the world frame."""

    def __init__(self) -> None:
        self.robot_width_m = 2 * ROBOT.radius_m
        """Width of a robot."""
        self._x: Floats = np.zeros((0, _STATES))  # x, y (m), vx, vy (m/s), ax, ay (m/s²)
        self._p: Floats = np.zeros((0, _STATES, _STATES))
        self.ages_s: Floats = np.zeros(0)
        """(n): time since each robot was last seen."""
        self._sightings: Indices = np.zeros(0, np.intp)
        self._again_s: Floats = np.zeros(0)  # age at which the frame after the first sighting has come
        self.ids: Indices = np.zeros(0, np.intp)
        """(n): number of each track since the first, which is 1; a robot that was lost gets a new one."""
        self._begun = 0

    def __len__(self) -> int:
        return len(self._x)

    @property
    def states(self) -> Floats:
        """(n, 4): x, y (m), vx, vy (m/s)."""
        return self._x[:, :4]

    @property
    def covariances(self) -> Floats:
        """(n, 4, 4) of the states."""
        return self._p[:, :4, :4]

    @property
    def sure(self) -> Indices:
        """Indices of the tracks with more than one sighting; a single sighting may be a ghost."""
        return np.flatnonzero(self._sightings > 1)

    def rows_after(self, duration_s: float) -> list[RobotRow]:
        """Returns places and velocities of the robots after `duration_s`, for contacts with the ball."""
        if not len(self):
            return []
        variances_m2 = (self._p[:, 0, 0] + self._p[:, 1, 1]) / 2
        return [
            (x_m + vx_m_s * duration_s, y_m + vy_m_s * duration_s, vx_m_s, vy_m_s, place_m2)
            for (x_m, y_m, vx_m_s, vy_m_s), place_m2 in zip(self.states.tolist(), variances_m2.tolist(), strict=True)
        ]

    def predict(self, duration_s: float, timeout_s: float) -> None:
        """Moves all tracks on by `duration_s`; drops those without a sighting for `timeout_s`.

        A robot that was seen only once may be a ghost: it is dropped after a quarter of `timeout_s`, but not before the
        next frame has come.
        """
        self.ages_s = self.ages_s + duration_s
        once_s = np.maximum(timeout_s / 4, self._again_s)
        current = self.ages_s <= np.where(self._sightings > 1, timeout_s, once_s)
        if not current.all():
            self._keep(current)
        motion, noise = _motion(duration_s)
        self._x = self._x @ motion.T
        self._p = motion @ self._p @ motion.T + noise

    def drop(self, numbers: Sequence[int]) -> None:
        """Ends the tracks with these `ids`."""
        self._keep(~np.isin(self.ids, numbers))

    def see(self, positions_m: Floats, covariances_m2: Floats, age_s: float = 0.0, next_s: float = 0.0) -> None:
        """Takes the sightings that one robot made in one frame, captured `age_s` ago, each of a different robot.

        Args:
            positions_m: (m, 2), world frame.
            covariances_m2: (m, 2, 2).
            age_s: time since the exposure.
            next_s: time after which the next frame of this robot has come; 0: not known.
        """
        if not len(positions_m):
            return
        tracks, seen, found = self._assign(positions_m, covariances_m2, age_s)
        if found is not None:
            self._x[tracks], self._p[tracks] = corrected(self._x[tracks], self._p[tracks], found)
            self.ages_s[tracks] = np.minimum(self.ages_s[tracks], age_s)
            self._sightings[tracks] += 1
        if len(seen) < len(positions_m):
            free = np.ones(len(positions_m), dtype=bool)
            free[seen] = False
            self._begin(positions_m[free], covariances_m2[free], age_s, next_s)
        self._join()

    def _assign(
        self, positions_m: Floats, covariances_m2: Floats, age_s: float
    ) -> tuple[Indices, Indices, Innovation | None]:
        """Returns the tracks that are seen (k), the sighting of each (k), and their differences; None without any."""
        if not len(self):
            return _NONE, _NONE, None
        predicted_m, gains, spreads = seen_at(self._x, self._p, age_s)
        rows, columns = _pairs(predicted_m.tolist(), positions_m.tolist())
        if len(set(rows)) < len(rows) or len(set(columns)) < len(columns):
            rows, columns = _best_pairs(positions_m[None] - predicted_m[:, None], spreads[:, None] + covariances_m2)
        tracks, seen = np.array(rows, np.intp), np.array(columns, np.intp)
        inverses, determinants = inverted(spreads[tracks] + covariances_m2[seen])
        while len(tracks):
            # Only the states of these tracks are multiplied: a product of more states may round otherwise.
            differences_m = positions_m[seen] - places_at(self._x[tracks], age_s)
            found = innovation_of(gains[tracks], differences_m, inverses, determinants)
            fits = found.surprises <= _GATE
            if fits.all():
                return tracks, seen, found
            tracks, seen, inverses, determinants = tracks[fits], seen[fits], inverses[fits], determinants[fits]
        return tracks, seen, None

    def _begin(self, positions_m: Floats, covariances_m2: Floats, age_s: float, next_s: float) -> None:
        """Begins a track from each sighting; the arguments are those of `see`."""
        count = len(positions_m)
        states, covariances = np.zeros((count, _STATES)), np.zeros((count, _STATES, _STATES))
        states[:, :2], covariances[:, :2, :2] = positions_m, covariances_m2
        moved_m, speed_m2_s2 = _UNKNOWN_SPEED_M_S * age_s, _UNKNOWN_SPEED_M_S**2
        unknown = (moved_m**2, moved_m**2, speed_m2_s2, speed_m2_s2, _ACCELERATION_M_S2**2, _ACCELERATION_M_S2**2)
        covariances[:, _AXES, _AXES] += np.array(unknown)
        self._x = np.concatenate((self._x, states))
        self._p = np.concatenate((self._p, covariances))
        self.ages_s = np.concatenate((self.ages_s, np.full(count, age_s)))
        self._again_s = np.concatenate((self._again_s, np.full(count, age_s + next_s)))
        self._sightings = np.concatenate((self._sightings, np.ones(count, np.intp)))
        self.ids = np.concatenate((self.ids, self._begun + 1 + np.arange(count)))
        self._begun += count

    def _join(self) -> None:
        """Drops one of two tracks in one place: the one with fewer sightings; of equals, the younger."""
        places_m, same_m2 = self._x[:, :2].tolist(), (_SAME * self.robot_width_m) ** 2
        if not any(
            (x_m - other_x_m) * (x_m - other_x_m) + (y_m - other_y_m) * (y_m - other_y_m) < same_m2
            for track, (x_m, y_m) in enumerate(places_m)
            for other_x_m, other_y_m in places_m[:track]
        ):
            return
        apart_m = self.states[:, None, :2] - self.states[None, :, :2]
        same = (apart_m**2).sum(axis=2) < same_m2
        kept = np.zeros(len(self), dtype=bool)
        for track in np.argsort(-self._sightings, kind="stable"):
            kept[track] = not (same[track] & kept).any()
        self._keep(kept)

    def _keep(self, which: Flags) -> None:
        self._x, self._p = self._x[which], self._p[which]
        self.ages_s, self._sightings, self.ids = self.ages_s[which], self._sightings[which], self.ids[which]
        self._again_s = self._again_s[which]


def _pairs(predicted_m: list[list[float]], positions_m: list[list[float]]) -> tuple[list[int], list[int]]:
    """Returns track and sighting of all pairs that are near enough to each other, track by track."""
    rows, columns = [], []
    for row, (x_m, y_m) in enumerate(predicted_m):
        for column, (seen_x_m, seen_y_m) in enumerate(positions_m):
            away_x_m, away_y_m = seen_x_m - x_m, seen_y_m - y_m
            if away_x_m * away_x_m + away_y_m * away_y_m <= _FARTHEST_M**2:
                rows.append(row)
                columns.append(column)
    return rows, columns


def _best_pairs(apart_m: Floats, spreads_m2: Floats) -> tuple[list[int], list[int]]:
    """Returns track and sighting of the pairs that fit best together, each in one pair at most.

    Args:
        apart_m: (n, m, 2), differences of n tracks and m sightings.
        spreads_m2: (n, m, 2, 2), their covariances.
    """
    surprises = _surprises(apart_m, spreads_m2)
    near = (surprises <= _GATE) & ((apart_m**2).sum(axis=2) <= _FARTHEST_M**2)
    rows, columns = linear_sum_assignment(np.where(near, surprises, _NO_PAIR))
    fits = near[rows, columns]
    return rows[fits].tolist(), columns[fits].tolist()


def any_near(
    positions_m: Iterable[Sequence[float]],
    variances_m2: Iterable[tuple[float, float]],
    known: Sequence[PlaceRow],
    within_m: float,
) -> bool:
    """Returns whether `without_known` may remove a sighting. False is certain, and found much faster than by a call.

    A squared Mahalanobis distance is at least the squared distance divided by the trace of the covariance.

    Args:
        positions_m: m pairs x, y of the sightings.
        variances_m2: m pairs of the sightings' variances along x and y.
        known: k known robots.
        within_m: see `without_known`.
    """
    gate, least_m2 = 1.001 * _GATE, 2 * (within_m / 3) ** 2  # a little more than the gate, for rounding errors
    for (x_m, y_m), (xx_m2, yy_m2) in zip(positions_m, variances_m2, strict=True):
        spread_m2 = xx_m2 + yy_m2 + least_m2
        for known_x_m, known_y_m, _, _, known_xx_m2, _, _, known_yy_m2 in known:
            away_x_m, away_y_m = x_m - known_x_m, y_m - known_y_m
            if away_x_m * away_x_m + away_y_m * away_y_m <= gate * (spread_m2 + known_xx_m2 + known_yy_m2):
                return True
    return False


def without_known(
    positions_m: Floats, covariances_m2: Floats, known_m: Floats, known_m2: Floats, within_m: float
) -> Flags:
    """Returns flags (m) of the sightings that remain when the sighting of each known robot is removed.

    Each known robot removes at most one sighting, so that an opponent beside a mate stays. Cameras see robots by their
    near sides only and at different times. A sighting within `within_m` of a known robot is therefore that robot,
    whatever the covariances are.

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
        if near.any():
            known, seen = linear_sum_assignment(np.where(near, surprises, _NO_PAIR))
            remain[seen[near[known, seen]]] = False
    return remain


@lru_cache(maxsize=32)
def _motion(duration_s: float) -> tuple[Floats, Floats]:
    """Returns the matrix (6, 6) that moves states by a step, and the noise (6, 6) that the step adds; cached."""
    fades = math.exp(-duration_s / _LASTS_S)
    motion = np.array(
        (
            (1.0, duration_s, _LASTS_S * (duration_s - _LASTS_S * (1.0 - fades))),
            (0.0, 1.0, _LASTS_S * (1.0 - fades)),
            (0.0, 0.0, fades),
        )
    )
    t = duration_s
    lasting = np.array(
        (
            (t**5 / 20, t**4 / 8, t**3 / 6),
            (t**4 / 8, t**3 / 3, t**2 / 2),
            (t**3 / 6, t**2 / 2, t),
        )
    )
    passing = np.array(((t**3 / 3, t**2 / 2, 0.0), (t**2 / 2, t, 0.0), (0.0, 0.0, 0.0)))
    noise: Floats = 2.0 * _ACCELERATION_M_S2**2 / _LASTS_S * lasting + _NOISE_M2_S3 * passing
    return np.asarray(np.kron(motion, np.eye(2)), np.float64), np.asarray(np.kron(noise, np.eye(2)), np.float64)


def _surprises(innovations: Floats, spreads: Floats) -> Floats:
    """Returns squared Mahalanobis distances (n, m) of innovations (n, m, 2) with covariances (n, m, 2, 2)."""
    weighted = (inverted(spreads)[0] @ innovations[..., None])[..., 0]
    return np.asarray((innovations * weighted).sum(axis=-1))

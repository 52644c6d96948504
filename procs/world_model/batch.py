"""Kalman filters side by side: corrects n states with position sightings in a few array operations.

States begin with x, y (m). If sightings have an age, states continue with vx, vy (m/s), ax, ay (m/s²).

The formulas are those of filterpy's `predict` and `update`; the tests compare them.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from procs.model.frames import Floats


class Innovation(NamedTuple):
    """Differences of n sightings and n predictions, before they are used."""

    gains: Floats
    """(n, k, 2): covariance of state and sighting."""
    inverses: Floats
    """(n, 2, 2): inverse covariance of the difference."""
    weighted: Floats
    """(n, 2): the difference, weighted by its inverse covariance."""
    surprises: Floats
    """(n): squared Mahalanobis distance of each sighting."""
    determinants: Floats
    """(n): of the covariances of the differences, in m⁴."""


def innovation(
    states: Floats, covariances: Floats, positions_m: Floats, spreads_m2: Floats, age_s: float
) -> Innovation:
    """Compares sightings, captured `age_s` ago, with predictions.

    Args:
        states: (n, k).
        covariances: (n, k, k) of the states.
        positions_m: (n, 2) or (2) of the sightings.
        spreads_m2: (n, 2, 2) or (2, 2) of the sightings: their covariances.
        age_s: time since the exposure.
    """
    predicted_m, gains, spreads = seen_at(states, covariances, age_s)
    return innovation_of(gains, positions_m - predicted_m, *inverted(spreads + spreads_m2))


def innovation_of(gains: Floats, differences_m: Floats, inverses: Floats, determinants: Floats) -> Innovation:
    """Returns the innovation of differences (..., 2), given the results of `inverted` for their covariances."""
    weighted = (inverses @ differences_m[..., None])[..., 0]
    return Innovation(gains, inverses, weighted, (differences_m * weighted).sum(axis=-1), determinants)


def seen_at(states: Floats, covariances: Floats, age_s: float) -> tuple[Floats, Floats, Floats]:
    """Returns what a sighting captured `age_s` ago is expected to show.

    Returns:
        Positions (n, 2), their covariance with the states (n, k, 2), and their covariance (n, 2, 2).
    """
    if not age_s:
        gains = covariances[:, :, :2]
        return states[:, :2], gains, gains[:, :2]
    sight = _sight(age_s)
    gains = covariances @ sight.T
    return states @ sight.T, gains, sight @ gains


def places_at(states: Floats, age_s: float) -> Floats:
    """Returns the positions (n, 2) that belong to states (n, k) `age_s` ago."""
    return states @ _sight(age_s).T if age_s else states[:, :2]


@lru_cache(maxsize=64)
def _sight(age_s: float) -> Floats:
    """Returns the matrix (2, 6) from states to the positions `age_s` ago; cached."""
    return np.asarray(np.kron(np.array((1.0, -age_s, age_s**2 / 2)), np.eye(2)), np.float64)


def corrected(states: Floats, covariances: Floats, found: Innovation) -> tuple[Floats, Floats]:
    """Returns states (n, k) and covariances (n, k, k) after the sightings."""
    after = covariances - found.gains @ found.inverses @ found.gains.transpose(0, 2, 1)
    moved = states + (found.gains @ found.weighted[..., None])[..., 0]
    return moved, (after + after.transpose(0, 2, 1)) / 2  # rounding errors would grow


def inverted(matrices: Floats) -> tuple[Floats, Floats]:
    """Returns inverses (..., 2, 2) and determinants (...) of symmetric matrices (..., 2, 2)."""
    a, b, d = matrices[..., 0, 0], matrices[..., 0, 1], matrices[..., 1, 1]
    determinants = a * d - b * b
    inverses = np.empty_like(matrices)
    inverses[..., 0, 0], inverses[..., 1, 1] = d, a
    inverses[..., 0, 1] = inverses[..., 1, 0] = -b
    return inverses / determinants[..., None, None], determinants

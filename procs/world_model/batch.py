"""Kalman filters side by side: n states x, y (m), vx, vy (m/s) with position sightings, in a few array operations.

The formulas are those of filterpy's `predict` and `update`, with which the tests compare them.
"""

from typing import NamedTuple

import numpy as np

from procs.model.frames import Floats


class Innovation(NamedTuple):
    """Differences of n sightings and n predictions, before they are used."""

    gains: Floats
    """(n, 4, 2): covariance of state and sighting."""
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
        states: (n, 4).
        covariances: (n, 4, 4) of the states.
        positions_m: (n, 2) or (2), sighted.
        spreads_m2: (n, 2, 2) or (2, 2), covariances of the sightings.
        age_s: time since the exposure.
    """
    gains, differences = covariances[:, :, :2], positions_m - states[:, :2]
    spreads = gains[:, :2]
    if age_s:
        gains = gains - age_s * covariances[:, :, 2:]
        spreads = gains[:, :2] - age_s * gains[:, 2:]
        differences += age_s * states[:, 2:]
    inverses, determinants = inverted(spreads + spreads_m2)
    weighted = (inverses @ differences[..., None])[..., 0]
    return Innovation(gains, inverses, weighted, (differences * weighted).sum(axis=1), determinants)


def corrected(states: Floats, covariances: Floats, found: Innovation) -> tuple[Floats, Floats]:
    """Returns states (n, 4) and covariances (n, 4, 4) after the sightings."""
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


def drift(covariances: Floats, duration_s: float) -> None:
    """Adds to the positions, in place, what the velocities (n, 4, 4) leave open after `duration_s`."""
    covariances[:, :2] += duration_s * covariances[:, 2:]
    covariances[:, :, :2] += duration_s * covariances[:, :, 2:]

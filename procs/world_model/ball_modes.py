"""Models of the ball's motion: the probabilities of passing from one to another, and the noise of each."""

from enum import IntEnum
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from procs.model.frames import Floats


class Mode(IntEnum):
    """Motion models."""

    RESTS = 0
    FREE = 1
    HANDLED = 2
    HIT = 3


class Contact(NamedTuple):
    """Effect of robots, posts and walls on the ball in a step."""

    hit: float = 0.0
    """Probability that a robot is in the way of a ball that would run on freely."""
    probability: float = 0.0
    """Probability that a robot, a post or a wall reaches the ball."""
    change_x_m_s: float = 0.0
    """Change of the velocity by the hit, as far as the places of ball and robot determine it."""
    change_y_m_s: float = 0.0
    after_s: float = 0.0
    """Time from the beginning of the step to the hit."""


NO_CONTACT = Contact()
MODES = len(Mode)
STATES = 7
"""Number of states: x, y, vx, vy, settled ux, uy, carpet; `ball_filter` explains them."""
_EACH = np.arange(MODES)
_CARPET = 6
_NOISE_M2_S3 = np.array((0.0001, 0.002, 5.0, 0.01))
"""Spectral density of the acceleration that each model does not predict."""
_SPIN_NOISE_M2_S3 = 0.002  # the same for the settled velocity
_HIT_M_S = 4.5  # deviation of the velocity that a hit adds: most touches add 1 to 3 m/s, kicks up to 11
_HIT_SPIN_M_S = 0.3  # deviation of the settled velocity by the spin that a hit adds
_CARPET_NOISE_1_S = 1e-5  # growth of the variance of the carpet's factor
_FREE_1_S = np.array(
    (
        (0.0, 0.02, 0.003, 0.003),
        (0.02, 0.0, 0.003, 0.003),
        (0.5, 8.0, 0.0, 0.5),
        (0.0, 0.0, 0.0, 0.0),
    )
)
"""Rates of passing from one model (row) to another (column) without a robot near the ball; `HIT` lasts one step."""
_CONTACT_1_S = np.array(
    (
        (0.0, 0.1, 1.0, 0.5),
        (0.02, 0.0, 1.5, 1.0),
        (0.3, 1.5, 0.0, 1.0),
        (0.0, 0.0, 0.0, 0.0),
    )
)
"""The same with a robot or a wall within reach."""
_AFTER_HIT = np.array((0.0, 0.85, 0.15, 0.0))


@lru_cache(maxsize=128)
def passes(duration_s: float, contact: float, slow: bool, flies: bool) -> Floats:
    """Returns the probabilities (old, new) of passing from model to model; cached.

    Args:
        duration_s: the step.
        contact: probability that a robot or a wall reaches the ball.
        slow: a free ball is about to rest.
        flies: the ball is in the air, where none rests.
    """
    rates_1_s = contact * _CONTACT_1_S + (1.0 - contact) * _FREE_1_S
    if slow:
        rates_1_s[Mode.FREE, Mode.RESTS] = 3.0
    if flies:
        rates_1_s[:, Mode.RESTS] = 0.0
    leaves_1_s = rates_1_s.sum(axis=1) + 1e-9
    stays = np.exp(-leaves_1_s * duration_s)
    moves = rates_1_s * ((1.0 - stays) / leaves_1_s)[:, None]
    moves[_EACH, _EACH] = stays
    moves[Mode.HIT] = _AFTER_HIT
    return np.asarray(moves)


@lru_cache(maxsize=32)
def noise(duration_s: float, rolling_share: float) -> Floats:
    """Returns the covariances (modes, 7, 7) that the models' accelerations add in a step; cached.

    `rolling_share` is the share of a kick's speed that is left when the ball begins to roll.
    """
    along = np.array((duration_s**3 / 3, duration_s**2 / 2, duration_s))
    matrices = np.zeros((MODES, STATES, STATES))
    for mode in Mode:
        place, both, velocity = _NOISE_M2_S3[mode] * along
        if mode is Mode.HIT:
            place, both, velocity = _HIT_M_S**2 * np.array((duration_s**2 / 3, duration_s / 2, 1.0))
        share = rolling_share if mode in (Mode.HIT, Mode.HANDLED) else 0.0
        spin = _HIT_SPIN_M_S**2 if mode is Mode.HIT else _SPIN_NOISE_M2_S3 * duration_s
        if mode is Mode.RESTS:
            place, both, velocity, spin = _NOISE_M2_S3[mode] * duration_s, 0.0, 1e-4, 1e-4
        for axis in (0, 1):
            axes = np.array((axis, axis + 2, axis + 4))
            matrices[mode][np.ix_(axes, axes)] = (
                (place, both, share * both),
                (both, velocity, share * velocity),
                (share * both, share * velocity, share**2 * velocity + spin),
            )
        matrices[mode, _CARPET, _CARPET] = _CARPET_NOISE_1_S * duration_s
    return matrices

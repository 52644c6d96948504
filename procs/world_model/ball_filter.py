"""Interacting multiple models of the ball: it rests, rolls, slides, is handled by a robot, or was hit just now.

Five Kalman filters with one state each (x, y in m, vx, vy in m/s, world frame) run side by side; after each step the
filters exchange what they believe, by the probabilities of passing from one model to another (Blom and Bar-Shalom,
1988). Robots near the ball make hits and handling probable; elsewhere the ball keeps rolling, and its velocity becomes
precise.
"""

import math
from enum import IntEnum
from functools import lru_cache

import numpy as np

from procs.model.ball import ROLLING_SHARE, SLIDING_M_S2
from procs.model.frames import Floats
from procs.world_model.batch import corrected, drift, innovation


class Mode(IntEnum):
    """Motion models."""

    RESTS = 0
    ROLLS = 1
    SLIDES = 2
    HANDLED = 3
    HIT = 4


_MODES = len(Mode)
_EACH = np.arange(_MODES)
_AXES, _OTHER = np.array((0, 1, 2, 3)), np.array((2, 3, 0, 1))  # x, y, vx, vy, and the partner of each
_NOISE_M2_S3 = np.array((0.0002, 0.01, 0.1, 5.0, 0.3))
"""Spectral density of the acceleration that each model leaves open."""
_HIT_M_S = 8.0  # deviation of the velocity that a hit adds
_SLOW_M_S = 0.15  # a rolling ball this slow is about to rest
_UNKNOWN_SPEED_M_S = 3.0
_CLUTTER_1_M2 = 1e-4  # density of false sightings; a sighting that is less probable does not fit
_BOUNCE = 0.5  # share of the speed that a wall leaves
_LEAST = 1e-6  # probability that every model keeps
_KICK_SPEED_SD = 0.06  # relative error of a kick's speed
_KICK_DIRECTION_SD = 0.03  # rad
_TURNS_M_S2 = SLIDING_M_S2 * ROLLING_SHARE / (1.0 - ROLLING_SHARE)
"""A ball that was hit t seconds ago and slides at v m/s begins to roll when v is t times this."""
_ROLLS_BELOW_M_S2, _SLIDES_ABOVE_M_S2 = 0.7 * _TURNS_M_S2, 1.4 * _TURNS_M_S2  # carpets differ by a third
_KICK_TIME_SD_S = 0.012  # the kick lies somewhere in the tick before its report: 40 ms by the root of 12
_FREE_1_S = np.array(
    (
        (0.0, 0.02, 0.0, 0.003, 0.003),
        (0.3, 0.0, 0.0, 0.003, 0.003),
        (0.0, 1.5, 0.0, 0.003, 0.003),
        (0.5, 6.0, 2.0, 0.0, 0.5),
        (0.0, 0.0, 0.0, 0.0, 0.0),
    )
)
"""Rates of passing from one model (row) to another (column) without a robot near the ball; `HIT` lasts one step."""
_CONTACT_1_S = np.array(
    (
        (0.0, 0.1, 0.0, 1.5, 0.8),
        (0.3, 0.0, 0.0, 3.0, 1.6),
        (0.0, 1.5, 0.0, 3.0, 1.6),
        (0.3, 1.0, 0.5, 0.0, 1.6),
        (0.0, 0.0, 0.0, 0.0, 0.0),
    )
)
"""The same with a robot or a wall within reach."""
_AFTER_HIT = np.array((0.0, 0.02, 0.83, 0.15, 0.0))
_FIRST = np.array((0.3, 0.3, 0.15, 0.2, 0.05))


class BallFilter:
    """Mixture of the models; `state` and `covariance` are those of the mixture."""

    def __init__(self, position_m: Floats, covariance_m2: Floats) -> None:
        """Starts from one sighting (2) with its covariance (2, 2); the velocity is unknown."""
        # Copies share arrays: methods replace them, or change those that they have just made.
        self._x = np.zeros((_MODES, 4))
        self._x[:, :2] = position_m
        self._p = np.zeros((_MODES, 4, 4))
        self._p[:, :2, :2] = covariance_m2
        self._p[:, 2:, 2:] = np.eye(2) * _UNKNOWN_SPEED_M_S**2
        self._p[Mode.RESTS, 2:, 2:] = np.eye(2) * 1e-4
        self._weights = _FIRST.copy()
        self._rolls_below_m_s = 0.0  # after a known kick the ball slides until it is slower
        self._free_s = math.nan  # time since a robot or a wall was near

    def copy(self) -> "BallFilter":
        """Returns the same mixture; neither follows what happens to the other."""
        made = BallFilter.__new__(BallFilter)
        made.__dict__.update(self.__dict__)
        return made

    @property
    def state(self) -> Floats:
        """(4): x, y, vx, vy."""
        return np.asarray(self._weights @ self._x)

    @property
    def covariance(self) -> Floats:
        """(4, 4) of the state."""
        apart = self._x - self.state
        return np.asarray(
            (self._weights @ self._p.reshape(_MODES, 16)).reshape(4, 4) + (apart.T * self._weights) @ apart
        )

    @property
    def weights(self) -> Floats:
        """(5): probability of each `Mode`."""
        return self._weights

    def predict(self, duration_s: float, rolling_m_s2: float, contact: bool = False) -> None:
        """Moves the ball on by `duration_s`.

        Args:
            duration_s: the step.
            rolling_m_s2: deceleration of the rolling ball.
            contact: a robot, a post or a wall may touch the ball.
        """
        if contact and self._free_s > 0.0:
            self._rolls_below_m_s = 0.0  # a robot that was not at the ball may have hit it
        self._free_s = 0.0 if contact else self._free_s + duration_s
        self._mix(self._moves(duration_s, contact))
        x, p = self._x, self._p
        velocities_m_s = x[:, 2:]
        speeds_m_s = np.hypot(x[:, 2], x[:, 3]) + 1e-9
        kept = np.maximum(0.0, 1.0 - _losses_m_s(duration_s, rolling_m_s2) / speeds_m_s)
        x[:, :2] += velocities_m_s * (duration_s * (1.0 + kept) / 2)[:, None]
        velocities_m_s *= kept[:, None]
        p[Mode.RESTS, 2:] = p[Mode.RESTS, :, 2:] = 0.0
        drift(p, duration_s)
        p += _noise(duration_s)

    def stay_within(self, x_m: float, y_m: float) -> None:
        """Lets a ball beyond the walls, at plus and minus these places of its middle, bounce off them."""
        limits_m = np.array((x_m, y_m))
        beyond = np.abs(self._x[:, :2]) > limits_m
        if beyond.any():
            self._x = self._x.copy()
            self._x[:, :2] = np.clip(self._x[:, :2], -limits_m, limits_m)
            self._x[:, 2:][beyond] *= -_BOUNCE

    def see(self, position_m: Floats, covariance_m2: Floats) -> bool:
        """Takes a sighting (2) with its covariance (2, 2); returns False if it does not fit."""
        found = innovation(self._x, self._p, position_m, covariance_m2, 0.0)
        likely = self._weights * np.exp(-found.surprises / 2) / (2 * math.pi * np.sqrt(found.determinants))
        evidence = float(likely.sum())
        if evidence < _CLUTTER_1_M2:
            return False
        self._x, self._p = corrected(self._x, self._p, found)
        self._weights = np.maximum(likely / evidence, _LEAST)
        self._weights /= self._weights.sum()
        return True

    def hold(self, state: Floats, covariance: Floats) -> None:
        """Takes the ball in a mouth: its state (4) with the covariance (4, 4), which replace the track's.

        The error of a robot's pose stays from tick to tick, so several ticks tell no more than one.
        """
        self._x, self._p = np.tile(state, (_MODES, 1)), np.tile(covariance, (_MODES, 1, 1))
        self._become(Mode.HANDLED)
        self._rolls_below_m_s = 0.0

    def kick(self, velocity_m_s: Floats) -> None:
        """Takes a kick that gave the ball about this velocity (2), world frame."""
        speed_m_s = float(np.hypot(*velocity_m_s))
        along = velocity_m_s / max(speed_m_s, 1e-9)
        across = np.array((-along[1], along[0]))
        position_m, covariance_m2 = self.state[:2], self.covariance[:2, :2]
        self._x, self._p = np.tile((*position_m, *velocity_m_s), (_MODES, 1)), np.zeros((_MODES, 4, 4))
        self._p[:, :2, :2] = covariance_m2 + np.outer(along, along) * (speed_m_s * _KICK_TIME_SD_S) ** 2
        self._p[:, 2:, 2:] = (
            np.outer(along, along) * (_KICK_SPEED_SD * speed_m_s + 0.2) ** 2
            + np.outer(across, across) * (_KICK_DIRECTION_SD * speed_m_s + 0.1) ** 2
        )
        self._become(Mode.SLIDES)
        self._rolls_below_m_s, self._free_s = ROLLING_SHARE * speed_m_s, 0.0

    def _become(self, mode: Mode) -> None:
        self._weights = np.full(_MODES, _LEAST)
        self._weights[mode] = 1.0 - _LEAST * (_MODES - 1)

    def _moves(self, duration_s: float, contact: bool) -> Floats:
        """Returns the probabilities (old, new) of passing from model to model.

        A fast ball does not rest. After a kick the ball slides until it has lost so much of its speed that it rolls:
        below a known speed if the kick is known, otherwise by the time since a robot could have hit it.
        """
        slow = math.hypot(*self._x[Mode.ROLLS, 2:]) < _SLOW_M_S
        slides: bool | None = None
        sliding_m_s = math.hypot(*self._x[Mode.SLIDES, 2:])
        if self._rolls_below_m_s:
            slides = sliding_m_s > self._rolls_below_m_s
        elif sliding_m_s > _SLIDES_ABOVE_M_S2 * self._free_s:
            slides = True
        elif sliding_m_s < _ROLLS_BELOW_M_S2 * self._free_s:
            slides = False
        return _passes(duration_s, contact, slow, slides, self._rolls_below_m_s > 0.0)

    def _mix(self, moves: Floats) -> None:
        """Lets the models exchange their beliefs by the probabilities (old, new) of passing from one to another."""
        weights = np.maximum(self._weights @ moves, 1e-12)
        shares = (self._weights[:, None] * moves / weights).T  # (new, old)
        mixed = shares @ self._x
        apart = self._x[None] - mixed[:, None]
        spread = (apart * shares[:, :, None]).transpose(0, 2, 1) @ apart
        self._p = (shares @ self._p.reshape(_MODES, 16)).reshape(_MODES, 4, 4) + spread
        self._x, self._weights = mixed, weights / weights.sum()


@lru_cache(maxsize=128)
def _passes(duration_s: float, contact: bool, slow: bool, slides: bool | None, kicked: bool) -> Floats:
    """Returns the probabilities (old, new) of passing from model to model; cached.

    Args:
        duration_s: the step.
        contact: a robot or a wall may touch the ball.
        slow: a rolling ball is about to rest.
        slides: whether a ball that was hit is still too fast to roll; None if that is not known.
        kicked: the kick is known.
    """
    rates_1_s = (_CONTACT_1_S if contact else _FREE_1_S).copy()
    rates_1_s[Mode.ROLLS, Mode.RESTS] = 3.0 if slow else 0.02
    if slides is not None:
        rates_1_s[Mode.SLIDES, Mode.ROLLS] = 0.3 if slides else 15.0
        likely, unlikely = (Mode.SLIDES, Mode.ROLLS) if slides else (Mode.ROLLS, Mode.SLIDES)
        rates_1_s[Mode.HANDLED, likely] += rates_1_s[Mode.HANDLED, unlikely]
        rates_1_s[Mode.HANDLED, unlikely] = 0.0
        if slides and kicked:
            rates_1_s[Mode.ROLLS, Mode.SLIDES] = 15.0
    leaves_1_s = rates_1_s.sum(axis=1) + 1e-9
    stays = np.exp(-leaves_1_s * duration_s)
    moves = rates_1_s * ((1.0 - stays) / leaves_1_s)[:, None]
    moves[_EACH, _EACH] = stays
    moves[Mode.HIT] = _AFTER_HIT
    return np.asarray(moves)


@lru_cache(maxsize=32)
def _losses_m_s(duration_s: float, rolling_m_s2: float) -> Floats:
    """Returns the speed (5) that each model takes from the ball in a step: all of it at rest; cached."""
    return np.array((np.inf, rolling_m_s2 * duration_s, SLIDING_M_S2 * duration_s, 0.0, 0.0))


@lru_cache(maxsize=32)
def _noise(duration_s: float) -> Floats:
    """Returns the covariances (5, 4, 4) that the models' accelerations add in a step; cached."""
    along = np.array((duration_s**3 / 3, duration_s**2 / 2, duration_s))
    noise = _NOISE_M2_S3[:, None] * along
    noise[Mode.HIT] += _HIT_M_S**2 * np.array((duration_s**2 / 3, duration_s / 2, 1.0))
    noise[Mode.RESTS] = (_NOISE_M2_S3[Mode.RESTS] * duration_s, 0.0, 1e-4)
    matrices = np.zeros((_MODES, 4, 4))
    matrices[:, _AXES, _AXES] = noise[:, (0, 0, 2, 2)]
    matrices[:, _AXES, _OTHER] = noise[:, 1:2]
    return matrices

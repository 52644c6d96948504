"""Interacting multiple models of the ball: it rests, runs freely, is handled by a robot, or was hit just now.

Four Kalman filters run side by side. In each step they mix their estimates by the probabilities of passing from one
model to another (Blom and Bar-Shalom, 1988). Robots near the ball make hits and handling probable; elsewhere the ball
runs freely, and its velocity becomes precise.

A free ball slides until its spin fits its speed, then it rolls. While it slides, its velocity changes straight towards
the settled velocity, which is known from the start: for a thin shell, three fifths of the velocity plus two fifths of
the velocity at which the ball would roll with its spin. Each filter has seven states: x, y in m, vx, vy in m/s, settled
ux, uy in m/s (all in the world frame), and the carpet, a factor of both decelerations that is learnt from every slide.
"""

import math
from typing import NamedTuple

import numpy as np

from procs.model.ball import BallModel
from procs.model.frames import Floats
from procs.world_model.ball_modes import MODES, NO_CONTACT, STATES, Contact, Mode, noise, passes
from procs.world_model.batch import corrected, innovation
from procs.world_model.carpet_friction import Friction, rubbed

_FOUR = np.arange(4)
_MOVING = (Mode.FREE, Mode.HANDLED, Mode.HIT)
_PLACE, _VELOCITY, _SETTLED, _CARPET = slice(0, 2), slice(2, 4), slice(4, 6), 6
_SLIP = np.array([STATES * row + column for row, column in ((2, 2), (3, 3), (4, 4), (5, 5), (2, 4), (3, 5))])
"""Places in a flat covariance of the parts of the variance of the slip, which is velocity minus settled velocity."""
_STILL = np.tile(np.eye(STATES), (MODES, 1, 1))
"""Derivatives of states that do not change, except the velocities of a resting ball, which are 0."""
_STILL[Mode.RESTS, 2:6] = 0.0
_SLOW_M_S = 0.15  # a free ball this slow is about to rest
_UNKNOWN_SPEED_M_S = 3.0  # deviation of an unknown velocity along an axis
_UNKNOWN_SETTLED = 0.85  # share of an unknown velocity in the settled one ...
_UNKNOWN_SLIP_M_S = 0.8  # ... and the deviation of the rest
_CARPET_SD = 0.18  # published decelerations differ by a third
_CLUTTER_1_M2 = 1e-4  # density of false sightings; a sighting that is less probable does not fit
_LEAST = 1e-6  # probability that every model keeps
_KICK_SPEED_SD, _KICK_SPEED_M_S = 0.06, 0.2  # error of a kick's speed: relative part, and part of slow kicks
_KICK_DIRECTION_SD, _KICK_ASIDE_M_S = 0.03, 0.1  # error across the kick: direction in rad, and part of slow kicks
_MISSES = 0.005  # probability that a reported kick did not reach the ball
_SPIN_SD_M_S = 1.0  # deviation of the spin from that of a rolling ball, before the track is considered
_HELD_SPIN_M_S = 0.4  # deviation of the spin of a ball in a mouth, which follows the robot with a delay
_LEVELS = 20  # number of steps to which the probability of a contact is rounded
_FIRST = np.array((0.3, 0.45, 0.2, 0.05))  # probability of each mode: at the first sighting, ...
_FIRST_MOVING = np.array((0.05, 0.7, 0.2, 0.05))  # ... at the first sighting of a moving ball, ...
_PUT_DOWN = np.array((0.97, 0.01, 0.01, 0.01))  # ... and after the crew has put the ball down


class Likeliest(NamedTuple):
    """State of the likeliest model: place and velocity, world frame, with their variances along an axis."""

    x_m: float
    y_m: float
    vx_m_s: float
    vy_m_s: float
    place_m2: float
    velocity_m2_s2: float


class BallFilter:
    """Mixture of the models; `state` and `covariance` are those of the mixture."""

    def __init__(
        self,
        position_m: Floats,
        covariance_m2: Floats,
        ball: BallModel,
        velocity_m_s: Floats | None = None,
        fastest_m_s: float = math.inf,
    ) -> None:
        """Starts from one sighting (2) with its covariance (2, 2).

        The velocity is unknown, or a guess (2). A sighting that needs a ball faster than `fastest_m_s` does not fit.
        """
        self._fastest_m_s = fastest_m_s
        self._sliding_m_s2 = ball.sliding_m_s2
        self._rolling_share = ball.rolling_share  # of the velocity, in the settled one ...
        self._spun_share = 1.0 - self._rolling_share  # ... and of the one at which the ball would roll with its spin
        # Copies share arrays: methods replace them, or change those that they have just made.
        self._x = np.zeros((MODES, STATES))
        self._x[:, _PLACE] = position_m
        self._x[:, _CARPET] = 1.0
        self._p = np.zeros((MODES, STATES, STATES))
        self._p[:, _PLACE, _PLACE] = covariance_m2
        if velocity_m_s is not None:
            self._x[1:, _VELOCITY], self._x[1:, _SETTLED] = velocity_m_s, _UNKNOWN_SETTLED * velocity_m_s
        moves = self._p[1:]
        moves[:, _VELOCITY, _VELOCITY] = np.eye(2) * _UNKNOWN_SPEED_M_S**2
        moves[:, _VELOCITY, _SETTLED] = moves[:, _SETTLED, _VELOCITY] = (
            np.eye(2) * _UNKNOWN_SPEED_M_S**2 * _UNKNOWN_SETTLED
        )
        moves[:, _SETTLED, _SETTLED] = np.eye(2) * (_UNKNOWN_SPEED_M_S**2 * _UNKNOWN_SETTLED**2 + _UNKNOWN_SLIP_M_S**2)
        self._p[Mode.RESTS, 2:6, 2:6] = np.eye(4) * 1e-4
        self._p[:, _CARPET, _CARPET] = _CARPET_SD**2
        self._weights = (_FIRST if velocity_m_s is None else _FIRST_MOVING).copy()
        self._mixture: tuple[Floats, Floats] | None = None  # mean and covariance, once asked for

    def copy(self) -> "BallFilter":
        """Returns the same mixture; neither follows what happens to the other."""
        made = BallFilter.__new__(BallFilter)
        made.__dict__.update(self.__dict__)
        return made

    @property
    def state(self) -> Floats:
        """(4): x, y, vx, vy."""
        return self._moments()[0][:4]

    @property
    def covariance(self) -> Floats:
        """(4, 4) of the state."""
        return self._moments()[1][:4, :4]

    @property
    def settled_m_s(self) -> Floats:
        """(2): velocity at which the ball will begin to roll."""
        return np.asarray(self._weights @ self._x[:, _SETTLED])

    @property
    def weights(self) -> Floats:
        """(4): probability of each `Mode`."""
        return self._weights

    @property
    def carpet(self) -> tuple[float, float]:
        """Factor of the decelerations on this carpet, and its variance."""
        factors = self._x[:, _CARPET]
        mean = float(self._weights @ factors)
        return mean, float(self._weights @ (self._p[:, _CARPET, _CARPET] + (factors - mean) ** 2))

    def lie_on(self, carpet: tuple[float, float]) -> None:
        """Takes over the carpet of another track, as its property `carpet` returned it."""
        self._x, self._p, self._mixture = self._x.copy(), self._p.copy(), None
        self._x[:, _CARPET] = carpet[0]
        self._p[:, _CARPET] = self._p[:, :, _CARPET] = 0.0
        self._p[:, _CARPET, _CARPET] = carpet[1]

    def rest(self) -> None:
        """Notes that the ball was put down: it rests, except for a small probability."""
        self._weights, self._mixture = _PUT_DOWN.copy(), None

    @property
    def likeliest(self) -> Likeliest:
        """State of the likeliest model, in a fraction of the time of the mixture's mean and covariance."""
        mode = int(self._weights.argmax())
        x_m, y_m, vx_m_s, vy_m_s = self._x[mode, :4].tolist()
        xx_m2, yy_m2, vv_m2_s2, ww_m2_s2 = self._p[mode].diagonal()[:4].tolist()
        return Likeliest(x_m, y_m, vx_m_s, vy_m_s, (xx_m2 + yy_m2) / 2, (vv_m2_s2 + ww_m2_s2) / 2)

    def predict(
        self, duration_s: float, rolling_m_s2: float, contact: Contact = NO_CONTACT, grounded_s: float | None = None
    ) -> None:
        """Moves the ball on by `duration_s`.

        Args:
            duration_s: the step.
            rolling_m_s2: deceleration of the rolling ball on the usual carpet.
            contact: effect of robots, posts and walls on the ball.
            grounded_s: part of the step in which the carpet acts on the ball; None: all of it.
        """
        grounded_s = duration_s if grounded_s is None else grounded_s
        _, _, vx_m_s, vy_m_s, ux_m_s, uy_m_s, _ = self._x[Mode.FREE].tolist()
        slow = max(math.hypot(vx_m_s, vy_m_s), math.hypot(ux_m_s, uy_m_s)) < _SLOW_M_S
        moves = passes(duration_s, round(contact.probability * _LEVELS) / _LEVELS, slow, grounded_s <= 0.0)
        if contact.hit > 0.0:
            moves = moves * (1.0 - contact.hit)
            moves[:, Mode.HIT] += contact.hit
        self._mix(moves)
        if contact.hit > 0.0:
            self._bounce(contact)
        motion = self._rub(duration_s, grounded_s, rolling_m_s2)
        self._mixture = None
        self._p = motion @ self._p @ motion.transpose(0, 2, 1) + noise(duration_s, self._rolling_share)

    def _bounce(self, contact: Contact) -> None:
        """Turns the ball that was hit by a robot within this step; `_mix` has made its states anew."""
        change_m_s = np.array((contact.change_x_m_s, contact.change_y_m_s))
        self._x[Mode.HIT, _PLACE] -= contact.after_s * change_m_s
        self._x[Mode.HIT, _VELOCITY] += change_m_s
        self._x[Mode.HIT, _SETTLED] += self._rolling_share * change_m_s

    def _rub(self, duration_s: float, grounded_s: float, rolling_m_s2: float) -> Floats:
        """Lets the ball move and the carpet act on it; returns the derivatives (modes, 7, 7) of the new states."""
        friction = Friction(self._sliding_m_s2, rolling_m_s2, self._rolling_share)
        resting, *moving = self._x.tolist()
        states, rows = [*resting[:2], 0.0, 0.0, 0.0, 0.0, resting[_CARPET]], []
        slips = self._p.reshape(MODES, -1)[1:, _SLIP].tolist()
        for mode, state, (vx_vx, vy_vy, ux_ux, uy_uy, vx_ux, vy_uy) in zip(_MOVING, moving, slips, strict=True):
            slip_m2_s2 = vx_vx + vy_vy + ux_ux + uy_uy - 2.0 * (vx_ux + vy_uy)
            moved, derivatives = rubbed(mode, state, slip_m2_s2 / 2.0, duration_s, grounded_s, friction)
            states += moved
            rows += derivatives
        self._x = np.array(states).reshape(MODES, STATES)
        motion = _STILL.copy()
        motion[1:, :_CARPET, 2:] = np.array(rows).reshape(len(_MOVING), _CARPET, -1)
        return motion

    def surely_within(self, x_m: float, y_m: float) -> bool:
        """Returns whether all models place the ball's middle within ±`x_m` and ±`y_m` of the origin.

        This takes a fraction of the time of the mixture's mean, which lies between those of the models.
        """
        return all(-x_m < state[0] < x_m and -y_m < state[1] < y_m for state in self._x[:, _PLACE].tolist())

    def stay_within(self, x_m: float, y_m: float, bounce: float) -> None:
        """Lets a ball bounce off the walls if its middle is beyond ±`x_m` or ±`y_m`.

        `bounce` is the share of the speed that a wall leaves.
        """
        limits_m = np.array((x_m, y_m))
        beyond = np.abs(self._x[:, _PLACE]) > limits_m
        if beyond.any():
            self._x = self._x.copy()
            self._x[:, _PLACE] = np.clip(self._x[:, _PLACE], -limits_m, limits_m)
            changes_m_s = np.where(beyond, (-bounce - 1.0) * self._x[:, _VELOCITY], 0.0)
            self._x[:, _VELOCITY] += changes_m_s
            self._x[:, _SETTLED] += self._rolling_share * changes_m_s
            self._mixture = None

    def see(self, position_m: Floats, covariance_m2: Floats) -> bool:
        """Takes a sighting (2) with its covariance (2, 2); returns False if it does not fit."""
        found = innovation(self._x, self._p, position_m, covariance_m2, 0.0)
        likely = self._weights * np.exp(-found.surprises / 2) / (2 * math.pi * np.sqrt(found.determinants))
        evidence = float(likely.sum())
        if evidence < _CLUTTER_1_M2:
            return False
        states, covariances = corrected(self._x, self._p, found)
        weights = np.maximum(likely / evidence, _LEAST)
        weights /= weights.sum()
        if math.hypot(*(weights @ states[:, _VELOCITY]).tolist()) > self._fastest_m_s:
            return False
        self._x, self._p, self._weights, self._mixture = states, covariances, weights, None
        return True

    def hold(self, state: Floats, covariance: Floats) -> None:
        """Takes a ball in a mouth: its state (4) and covariance (4, 4) replace those of the track.

        The error of a robot's pose lasts from tick to tick, so several ticks know no more than one. The spin follows
        the mouth as fast as the carpet can turn the ball.
        """
        spin_m_s, spin_m2_s2 = self._spin(state[2:], _HELD_SPIN_M_S)
        self._set(state, covariance, spin_m_s, spin_m2_s2)
        self._become(Mode.HANDLED)

    def kick(
        self,
        velocity_m_s: Floats,
        position_m: Floats | None = None,
        covariance_m2: Floats | None = None,
        time_sd_s: float = 0.0,
    ) -> None:
        """Takes a kick; a small probability is left that it did not reach the ball.

        Args:
            velocity_m_s: (2), of the ball after the kick, world frame.
            position_m: (2), of the ball at the kick; None: as in the track.
            covariance_m2: (2, 2) of that position.
            time_sd_s: deviation of the time of the kick.
        """
        speed_m_s = float(np.hypot(*velocity_m_s))
        along = velocity_m_s / max(speed_m_s, 1e-9)
        across = np.array((-along[1], along[0]))
        if position_m is None or covariance_m2 is None:
            position_m, covariance_m2 = self.state[:2], self.covariance[:2, :2]
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = covariance_m2 + np.outer(along, along) * (speed_m_s * time_sd_s) ** 2
        covariance[2:, 2:] = (
            np.outer(along, along) * (_KICK_SPEED_SD * speed_m_s + _KICK_SPEED_M_S) ** 2
            + np.outer(across, across) * (_KICK_DIRECTION_SD * speed_m_s + _KICK_ASIDE_M_S) ** 2
        )
        before = self._moments()
        self._set(np.concatenate((position_m, velocity_m_s)), covariance, *self._spin(self.state[2:], 0.0))
        self._become(Mode.FREE)
        self._may_have_missed(*before)

    def _may_have_missed(self, mean: Floats, covariance: Floats) -> None:
        """Leaves a probability for a ball that rests where it was, at the mean (7) with the covariance (7, 7)."""
        rests, rests_2 = self._x[Mode.RESTS], self._p[Mode.RESTS]
        rests[:], rests_2[:] = mean, covariance
        rests[2:6] = 0.0
        rests_2[2:6] = rests_2[:, 2:6] = 0.0
        rests_2[2:6, 2:6] = np.eye(4) * 1e-4
        self._weights[Mode.RESTS] = _MISSES
        self._weights[Mode.FREE] -= _MISSES

    def _spin(self, rolling_m_s: Floats, least_m_s: float) -> tuple[Floats, Floats]:
        """Returns the velocity (2) at which the ball would roll with its spin, and its covariance (2, 2).

        What the track tells is weighed against a ball that rolls at a velocity (2); `least_m_s` is the least deviation.
        """
        mean, covariance = self._moments()
        of_velocity, of_settled = -self._rolling_share / self._spun_share, 1.0 / self._spun_share
        told_m_s = of_velocity * mean[_VELOCITY] + of_settled * mean[_SETTLED]
        told_m2_s2 = (
            of_velocity**2 * np.trace(covariance[_VELOCITY, _VELOCITY])
            + of_settled**2 * np.trace(covariance[_SETTLED, _SETTLED])
            + 2 * of_velocity * of_settled * np.trace(covariance[_VELOCITY, _SETTLED])
        ) / 2
        share = _SPIN_SD_M_S**2 / (_SPIN_SD_M_S**2 + max(0.0, float(told_m2_s2)))
        return rolling_m_s + share * (told_m_s - rolling_m_s), np.eye(2) * max(least_m_s**2, share * float(told_m2_s2))

    def _set(self, state: Floats, covariance: Floats, spin_m_s: Floats, spin_m2_s2: Floats) -> None:
        """Sets all models to one state (4) with its covariance (4, 4), and one spin (2) with its covariance (2, 2)."""
        factor, variance = self.carpet
        to_all = np.zeros((STATES, 4))
        to_all[_FOUR, _FOUR] = 1.0
        to_all[4, 2] = to_all[5, 3] = self._rolling_share
        x, p = to_all @ state, to_all @ covariance @ to_all.T
        x[_SETTLED] += self._spun_share * spin_m_s
        p[_SETTLED, _SETTLED] += self._spun_share**2 * spin_m2_s2
        x[_CARPET], p[_CARPET, _CARPET] = factor, variance
        self._x, self._p = np.tile(x, (MODES, 1)), np.tile(p, (MODES, 1, 1))

    def _become(self, mode: Mode) -> None:
        """Makes one model nearly certain."""
        self._mixture = None
        self._weights = np.full(MODES, _LEAST)
        self._weights[mode] = 1.0 - _LEAST * (MODES - 1)

    def _moments(self) -> tuple[Floats, Floats]:
        """Returns mean (7) and covariance (7, 7) of the mixture, which are computed once."""
        if self._mixture is None:
            mean = self._weights @ self._x
            apart = self._x - mean
            within = (self._weights @ self._p.reshape(MODES, -1)).reshape(STATES, STATES)
            self._mixture = mean, within + (apart.T * self._weights) @ apart
        return self._mixture

    def _mix(self, moves: Floats) -> None:
        """Lets the models exchange their beliefs by the probabilities (old, new) of passing from one to another."""
        weights = np.maximum(self._weights @ moves, 1e-12)
        shares = (self._weights[:, None] * moves / weights).T  # (new, old)
        mixed = shares @ self._x
        apart = self._x[None] - mixed[:, None]
        spread = (apart * shares[:, :, None]).transpose(0, 2, 1) @ apart
        self._p = (shares @ self._p.reshape(MODES, -1)).reshape(MODES, STATES, STATES) + spread
        self._x, self._weights = mixed, weights / weights.sum()

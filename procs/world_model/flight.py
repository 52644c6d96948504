"""Height of a ball in the air: a Kalman filter of height and lift, with bounces where the parabola meets the carpet."""

import math
from dataclasses import dataclass

from procs.model.ball import BallModel
from procs.model.normal import normal_cdf

_GRAVITY_M_S2 = 9.81
_SEEN_M = 0.03  # deviation of a height that follows from the ball's size
_LOW_M = 0.02  # height of a flying ball that seems to lie on the ground
_LOB_M_S, _LOB_SD_M_S = 4.0, 1.5  # lift of a lob that was kicked a moment ago, and its deviation
_UNKNOWN_LIFT_M_S = 4.0  # deviation of an unknown lift
_KICK_SHARE = 0.08  # relative deviation of a kick's lift
_BOUNCE_SHARE = 0.1  # relative deviation of the lift after a bounce
_NOISE_M2_S3 = 0.05  # spectral density of the vertical acceleration besides gravity
_FITS = 4.0  # number of deviations within which a height fits
_LEAST_LIFT_M_S = 0.3  # a kick with less lift rolls
_LEAST_REBOUND_M_S = 0.01  # the ball stays on the ground with less, whatever its settings say


@dataclass(frozen=True)
class Flight:
    """Height of the ball's lowest point in m and its lift, the speed upwards in m/s, with their covariance."""

    height_m: float
    lift_m_s: float
    height_m2: float
    both_m2_s: float
    lift_m2_s2: float

    @classmethod
    def of_kick(cls, lift_m_s: float) -> "Flight | None":
        """Returns the flight of a ball that was just kicked, or None if it rolls."""
        if lift_m_s < _LEAST_LIFT_M_S:
            return None
        return cls(0.0, lift_m_s, _SEEN_M**2, 0.0, (_KICK_SHARE * lift_m_s) ** 2)

    @classmethod
    def of_sight(cls, height_m: float, rises: bool = False) -> "Flight | None":
        """Returns the flight of a ball that was just seen for the first time, or None if it lies on the ground.

        `rises` states that the ball was on the ground a moment ago.
        """
        if height_m <= 0.0:
            return None
        lift_m_s, deviation_m_s = (_LOB_M_S, _LOB_SD_M_S) if rises else (0.0, _UNKNOWN_LIFT_M_S)
        return cls(height_m, lift_m_s, _SEEN_M**2, 0.0, deviation_m_s**2)

    def moved(self, duration_s: float, ball: BallModel) -> "tuple[Flight | None, float]":
        """Returns the flight after a step, or None once the ball has landed, and the time in s on the ground meanwhile.

        The ball bounces until its lift is small.
        """
        flight, least_m_s = self, max(ball.least_rebound_m_s, _LEAST_REBOUND_M_S)
        while True:
            lands_m_s = math.sqrt(flight.lift_m_s**2 + 2 * _GRAVITY_M_S2 * max(0.0, flight.height_m))
            lands_s = (flight.lift_m_s + lands_m_s) / _GRAVITY_M_S2
            if lands_s > duration_s:
                return flight._in_the_air(duration_s), 0.0
            duration_s -= lands_s
            rebound_m_s = ball.bounce * lands_m_s
            if rebound_m_s <= least_m_s:
                return None, duration_s
            before, share = flight._in_the_air(lands_s), ball.bounce**2
            lift_m2_s2 = share * before.lift_m2_s2 + (_BOUNCE_SHARE * rebound_m_s) ** 2
            flight = Flight(0.0, rebound_m_s, share * before.height_m2, share * before.both_m2_s, lift_m2_s2)

    def seen(self, height_m: float) -> "Flight | None":
        """Returns the flight after a sighting at a height (0: the ball seems to lie); None if that does not fit."""
        apart_m = (height_m if height_m > 0.0 else _LOW_M) - self.height_m
        variance_m2 = self.height_m2 + _SEEN_M**2
        if apart_m * apart_m > _FITS**2 * variance_m2:
            return None
        gain, lift_gain_1_s = self.height_m2 / variance_m2, self.both_m2_s / variance_m2
        return Flight(
            self.height_m + gain * apart_m,
            self.lift_m_s + lift_gain_1_s * apart_m,
            (1.0 - gain) * self.height_m2,
            (1.0 - gain) * self.both_m2_s,
            self.lift_m2_s2 - lift_gain_1_s * self.both_m2_s,
        )

    def probably_below(self, height_m: float, duration_s: float) -> float:
        """Returns the probability that the ball will be lower than `height_m` after a step in the air."""
        then = self._in_the_air(duration_s)
        return normal_cdf((height_m - then.height_m) / math.sqrt(then.height_m2))

    def _in_the_air(self, duration_s: float) -> "Flight":
        fallen_m_s = _GRAVITY_M_S2 * duration_s
        return Flight(
            self.height_m + (self.lift_m_s - fallen_m_s / 2) * duration_s,
            self.lift_m_s - fallen_m_s,
            self.height_m2 + (2 * self.both_m2_s + self.lift_m2_s2 * duration_s) * duration_s,
            self.both_m2_s + self.lift_m2_s2 * duration_s,
            self.lift_m2_s2 + _NOISE_M2_S3 * duration_s,
        )

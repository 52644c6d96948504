"""Kalman filter of the ball: position and velocity on the ground, slowed down by friction."""

import math

import numpy as np
from filterpy.kalman import KalmanFilter

from procs.model.ball import ROLLING_SHARE, SLIDING_M_S2
from procs.model.frames import Floats

_UNKNOWN_SPEED_M_S = 4.0
_STEADY_M_S2 = 0.25  # unmodelled acceleration of a ball at rest
_UNSTEADY_1_S = 0.4  # its growth with speed: sliding after a kick, unknown friction
_KICK_SPEED_SD = 0.15  # relative error of a kick's speed
_KICK_DIRECTION_SD = 0.05  # rad
_KICK_TIME_SD_S = 0.03  # the kick lies somewhere in the tick before its report
_STRAIN_MEMORY_S = 0.2  # time constant of the mean surprise
_STRAIN_MOST = 6.0


class BallFilter:
    """State: x, y (m), vx, vy (m/s) in the world frame.

    Sightings that are further from the prediction than their covariances allow, one after the other, raise the process
    noise for a short time: the ball slides, was deflected, or is carried.
    """

    def __init__(self, position_m: Floats, covariance_m2: Floats) -> None:
        """Starts from one sighting (2) with its covariance (2, 2); the velocity is unknown."""
        self._filter = KalmanFilter(dim_x=4, dim_z=2)
        self._filter.x[:2, 0] = position_m
        self._filter.P[:2, :2] = covariance_m2
        self._filter.P[2:, 2:] = np.eye(2) * _UNKNOWN_SPEED_M_S**2
        self._strain = 1.0
        self._since_update_s = 0.0
        self._rolls_below_m_s = math.inf  # after a kick the ball slides until it is slower

    @property
    def state(self) -> Floats:
        """(4): x, y, vx, vy."""
        return np.asarray(self._filter.x[:, 0])

    @property
    def covariance(self) -> Floats:
        """(4, 4) of the state."""
        return np.asarray(self._filter.P)

    def predict(self, duration_s: float, rolling_m_s2: float) -> None:
        """Lets the ball roll for `duration_s`; friction, a deceleration, stops it and never reverses it."""
        self._since_update_s += duration_s
        speed_m_s = float(np.hypot(*self._filter.x[2:, 0]))
        loss_m_s2 = SLIDING_M_S2 if speed_m_s > self._rolls_below_m_s else rolling_m_s2
        kept = max(0.0, 1.0 - loss_m_s2 * duration_s / max(speed_m_s, 1e-9))
        motion = np.eye(4)
        motion[0, 2] = motion[1, 3] = duration_s
        deviation_m_s2 = (_STEADY_M_S2 + _UNSTEADY_1_S * speed_m_s) * self._strain
        push = np.array((duration_s**2 / 2, duration_s))
        noise = np.kron(np.outer(push, push), np.eye(2)) * deviation_m_s2**2
        self._filter.predict(F=motion, Q=noise)
        mean_loss = (1.0 - kept) / 2 * duration_s
        self._filter.x[:2] -= mean_loss * self._filter.x[2:]
        self._filter.x[2:] *= kept

    def surprise(self, position_m: Floats, covariance_m2: Floats, age_s: float = 0.0) -> float:
        """Returns the squared Mahalanobis distance of a sighting (2) captured `age_s` ago."""
        seen_as = _seen_as(age_s)
        innovation = position_m - seen_as @ self.state
        spread = seen_as @ self._filter.P @ seen_as.T + covariance_m2
        return float(innovation @ np.linalg.solve(spread, innovation))

    def see(self, position_m: Floats, covariance_m2: Floats, age_s: float = 0.0) -> None:
        """Takes a sighting (2) with its covariance (2, 2), captured `age_s` ago."""
        surprise = self.surprise(position_m, covariance_m2, age_s) / 2  # 1 on average for an honest filter
        share = 1.0 - math.exp(-max(self._since_update_s, 0.01) / _STRAIN_MEMORY_S)
        self._strain += share * (min(_STRAIN_MOST, max(1.0, surprise)) - self._strain)
        self._since_update_s = 0.0
        self._filter.update(position_m[:, None], R=covariance_m2, H=_seen_as(age_s))

    def hold(self, state: Floats, covariance: Floats) -> None:
        """Takes a ball in the mouth: its state (4) with the covariance (4, 4)."""
        self._strain, self._since_update_s, self._rolls_below_m_s = 1.0, 0.0, math.inf
        self._filter.update(state[:, None], R=covariance, H=np.eye(4))

    def kick(self, velocity_m_s: Floats) -> None:
        """Takes a kick that gave the ball about this velocity (2), world frame."""
        speed_m_s = float(np.hypot(*velocity_m_s))
        along = velocity_m_s / max(speed_m_s, 1e-9)
        across = np.array((-along[1], along[0]))
        self._rolls_below_m_s = ROLLING_SHARE * speed_m_s
        self._filter.x[2:, 0] = velocity_m_s
        self._filter.P[2:, :2] = self._filter.P[:2, 2:] = 0.0
        self._filter.P[:2, :2] += np.outer(along, along) * (speed_m_s * _KICK_TIME_SD_S) ** 2
        self._filter.P[2:, 2:] = (
            np.outer(along, along) * (_KICK_SPEED_SD * speed_m_s + 0.3) ** 2
            + np.outer(across, across) * (_KICK_DIRECTION_SD * speed_m_s + 0.1) ** 2
        )


def _seen_as(age_s: float) -> Floats:
    """Measurement matrix (2, 4) of a position that was seen `age_s` ago."""
    return np.array(((1.0, 0.0, -age_s, 0.0), (0.0, 1.0, 0.0, -age_s)))

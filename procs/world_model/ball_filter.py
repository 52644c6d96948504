"""Kalman filter of the ball: position and velocity on the ground, slowed down by friction."""

import numpy as np
from filterpy.kalman import KalmanFilter

from procs.model.frames import Floats

_UNKNOWN_SPEED_M_S = 4.0
_STEADY_M_S2 = 0.25  # unmodelled acceleration of a ball at rest
_UNSTEADY_PER_S = 0.4  # and what each m/s of speed adds: sliding after a kick, unknown friction


class BallFilter:
    """State: x, y (m), vx, vy (m/s) in the world frame."""

    def __init__(self, position_m: Floats, covariance_m2: Floats) -> None:
        """A ball seen once at a position (2): nothing is known of its velocity."""
        self._filter = KalmanFilter(dim_x=4, dim_z=2)
        self._filter.x[:2, 0] = position_m
        self._filter.P[:2, :2] = covariance_m2
        self._filter.P[2:, 2:] = np.eye(2) * _UNKNOWN_SPEED_M_S**2

    @property
    def state(self) -> Floats:
        """(4): x, y, vx, vy."""
        return np.asarray(self._filter.x[:, 0])

    @property
    def covariance(self) -> Floats:
        """(4, 4) of the state."""
        return np.asarray(self._filter.P)

    def predict(self, duration_s: float, rolling_m_s2: float) -> None:
        """Lets the ball roll on; friction (its deceleration) stops it, it never turns it round."""
        speed_m_s = float(np.hypot(*self._filter.x[2:, 0]))
        kept = max(0.0, 1.0 - rolling_m_s2 * duration_s / max(speed_m_s, 1e-9))
        motion = np.eye(4)
        motion[0, 2] = motion[1, 3] = duration_s
        deviation_m_s2 = _STEADY_M_S2 + _UNSTEADY_PER_S * speed_m_s
        push = np.array((duration_s**2 / 2, duration_s))
        noise = np.kron(np.outer(push, push), np.eye(2)) * deviation_m_s2**2
        self._filter.predict(F=motion, Q=noise)
        mean_loss = (1.0 - kept) / 2 * duration_s
        self._filter.x[:2] -= mean_loss * self._filter.x[2:]
        self._filter.x[2:] *= kept

    def surprise(self, position_m: Floats, covariance_m2: Floats, age_s: float = 0.0) -> float:
        """Squared Mahalanobis distance of a sighting (2) that was made `age_s` ago."""
        seen = _seen(age_s)
        innovation = position_m - seen @ self.state
        spread = seen @ self._filter.P @ seen.T + covariance_m2
        return float(innovation @ np.linalg.solve(spread, innovation))

    def see(self, position_m: Floats, covariance_m2: Floats, age_s: float = 0.0) -> None:
        """A sighting (2) with its covariance (2, 2), made `age_s` ago: it tells where the ball was then."""
        self._filter.update(position_m[:, None], R=covariance_m2, H=_seen(age_s))

    def hold(self, state: Floats, deviations: tuple[float, float]) -> None:
        """The ball is known to be at a place and move with it (4), up to deviations in m and m/s."""
        variance = np.diag(np.repeat(np.square(deviations), 2))
        self._filter.update(state[:, None], R=variance, H=np.eye(4))

    def kick(self, heading_rad: float) -> None:
        """Somebody kicked it that way, at an unknown speed."""
        along = np.array((np.cos(heading_rad), np.sin(heading_rad)))
        self._filter.P[2:, 2:] += np.outer(along, along) * _UNKNOWN_SPEED_M_S**2 + np.eye(2) * 0.5**2


def _seen(age_s: float) -> Floats:
    return np.array(((1.0, 0.0, -age_s, 0.0), (0.0, 1.0, 0.0, -age_s)))

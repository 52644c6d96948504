"""Motion of a robot from tick to tick: its way by the wheels, its turn by the gyro, which does not slip."""

import math

import numpy as np

from fwk import Clock
from lcmtypes.robot import odometry_t
from procs.localization.self_localizer import Motion
from procs.model.frames import rotation
from procs.model.geometry import plausible, wrap_rad
from procs.model.robot import FASTEST_M_S, FASTEST_RAD_S

_ODOMETRY_S = 0.5  # a velocity counts for so long; then the robot counts as standing, as with silent wheels
_RECKONED_S = 0.25  # without odometry for so long, the robot drives on as before; it could brake or be stopped


class DeadReckoning:
    """The motions until now. In ticks without odometry, the robot drives on as before, for some time."""

    def __init__(self, clock: Clock) -> None:
        self.velocity_m_s = (0.0, 0.0)
        """Present velocity in the robot frame; zeros before the first odometry."""
        self.turning_rad_s = 0.0
        """Mean turning speed of the newest motion."""
        self._turning_sd_rad_s = 0.0  # of the wheels turning speed, as the newest odometry states it
        self._clock = clock
        self._last: odometry_t | None = None
        self._last_us = 0
        self._place = (0.0, 0.0, 0.0)  # odometry frame: where the motions until now have led, in m, m, rad
        self._tick_us = 0  # time of the newest tick, ...
        self._moved_us = 0  # ... and of the newest one until which all of the motion is known
        self._yaw_rate_rad_s: float | None = None  # of the gyro in the newest tick

    @property
    def has_begun(self) -> bool:
        """Whether there was any odometry."""
        return self._last is not None

    def motion(self, odometry: odometry_t | None, yaw_rate_rad_s: float | None) -> Motion:
        """Returns the motion since the last tick.

        Args:
            odometry: of this tick; None if there is none. One that cannot be counts as none.
            yaw_rate_rad_s: of the gyro in this tick; without it, the turn is that of the wheels, with their error.
        """
        passed_s, is_known = self._clock.since_s(self._tick_us), self._moved_us == self._tick_us
        self._tick_us = self._clock.now_us
        mean_rad_s = self._mean_rad_s(yaw_rate_rad_s)
        if odometry is None or not _is_sound(odometry):
            return self._reckoned(mean_rad_s, passed_s, is_known)
        now, last, longest_s = odometry, self._last, max(self._clock.since_s(self._last_us), self._clock.period_s)
        x_m, y_m, heading_rad = self._place if last else (now.x_m, now.y_m, now.heading_rad)
        moved_s, self._moved_us = self._clock.since_s(self._moved_us), self._clock.now_us
        self._last, self._last_us = now, self._clock.now_us
        self._place = now.x_m, now.y_m, now.heading_rad
        self.velocity_m_s = now.vx_m_s, now.vy_m_s
        turn_rad = wrap_rad(now.heading_rad - heading_rad)
        self.turning_rad_s = now.omega_rad_s if plausible(now.omega_rad_s) else 0.0
        self._turning_sd_rad_s = _turning_sd_rad_s(now)
        way_m = rotation(-heading_rad - turn_rad / 2) @ (now.x_m - x_m, now.y_m - y_m)
        too_far = np.hypot(*way_m) > FASTEST_M_S * longest_s or abs(turn_rad) > FASTEST_RAD_S * longest_s
        if too_far or (last and now.path_length_m < last.path_length_m):
            way_m, turn_rad = np.zeros(2), 0.0  # the driver restarted: its frame has moved, not the robot
        turn_sd_rad = moved_s * self._turning_sd_rad_s if last else 0.0
        if last and is_known and mean_rad_s is not None:
            turn_rad, self.turning_rad_s, turn_sd_rad = wrap_rad(mean_rad_s * passed_s), mean_rad_s, 0.0
        return Motion(float(way_m[0]), float(way_m[1]), turn_rad, float(np.hypot(*self.velocity_m_s)), turn_sd_rad)

    def _reckoned(self, mean_rad_s: float | None, passed_s: float, is_known: bool) -> Motion:
        """Returns the motion of a tick without odometry. What is wrong with it is made good with the next odometry.

        Args:
            mean_rad_s: turning speed by the gyro, which counts however long the odometry is silent; None without it.
            passed_s: time since the tick before.
            is_known: whether all of the motion until then is known.
        """
        silent_s = self._clock.since_s(self._last_us)
        if silent_s > _ODOMETRY_S:
            self.velocity_m_s, self.turning_rad_s = (0.0, 0.0), 0.0
        stands = silent_s > _RECKONED_S
        if self._last is None or (stands and mean_rad_s is None):
            return Motion(0.0, 0.0, 0.0, 0.0)
        if is_known:
            self._moved_us = self._clock.now_us
        turn_sd_rad = passed_s * self._turning_sd_rad_s if mean_rad_s is None else 0.0
        if mean_rad_s is not None:
            self.turning_rad_s = mean_rad_s
        turn_rad, (x_m, y_m, heading_rad) = passed_s * self.turning_rad_s, self._place
        if stands:
            self._place = x_m, y_m, heading_rad + turn_rad
            return Motion(0.0, 0.0, turn_rad, 0.0)
        ahead_m, left_m = rotation(-turn_rad / 2) @ self.velocity_m_s * passed_s
        way_x_m, way_y_m = rotation(heading_rad) @ self.velocity_m_s * passed_s
        vx_m_s, vy_m_s = rotation(-turn_rad) @ self.velocity_m_s
        self.velocity_m_s = float(vx_m_s), float(vy_m_s)
        self._place = x_m + float(way_x_m), y_m + float(way_y_m), heading_rad + turn_rad
        return Motion(float(ahead_m), float(left_m), turn_rad, float(np.hypot(vx_m_s, vy_m_s)), turn_sd_rad)

    def _mean_rad_s(self, yaw_rate_rad_s: float | None) -> float | None:
        """Returns the mean of this yaw rate and that of the tick before, if there was one; None without the gyro."""
        before_rad_s, self._yaw_rate_rad_s = self._yaw_rate_rad_s, yaw_rate_rad_s
        if yaw_rate_rad_s is None or before_rad_s is None:
            return yaw_rate_rad_s
        return (yaw_rate_rad_s + before_rad_s) / 2


def _turning_sd_rad_s(odometry: odometry_t) -> float:
    """Returns the deviation of the wheels' turning speed; 0 if the odometry states none that can be."""
    variance = odometry.velocity_covariance[2][2]
    return math.sqrt(variance) if 0.0 <= variance <= FASTEST_RAD_S**2 else 0.0


def _is_sound(odometry: odometry_t) -> bool:
    return plausible(odometry.x_m, odometry.y_m, odometry.heading_rad, odometry.vx_m_s, odometry.vy_m_s)

"""Kalman filter of a robot's pose: driven by odometry, corrected by matches with the field's lines."""

import math

import numpy as np

from procs.model.algebra import product
from procs.model.estimation import predict, update
from procs.model.frames import Floats, rotation
from procs.model.geometry import wrap_rad

_TICK_S = 0.05  # the errors below add up in this time
_PATH_ERROR = 0.1  # error as a share of the way: wheel scale, encoder noise, slip
_STANDING_M = 0.002  # error of the place of a standing robot
_TURN_ERROR = 0.03  # error as a share of the turn
_STANDING_RAD = 0.002  # error of the heading of a standing robot
_BLIND_S = 0.2  # time without a frame after which lasting errors of wheels count; before, _PATH_ERROR covers them
_STRAIN_MEMORY_S = 0.17  # time constant of the mean innovation
_STRAIN_SHARE = 0.5  # of the squared mean innovation; the rest is noise of the measurements
_NO_ERROR, _UNIT, _AXES = np.zeros(3), np.eye(3), np.arange(3)


class PoseFilter:
    """Error-state Kalman filter of a pose.

    Its state is the small error of x, y and heading, which is zero except during a correction. The filter's algebra
    therefore never meets an angle that wraps around.
    """

    def __init__(self, pose: Floats, deviations: tuple[float, float, float]) -> None:
        """Begins at a pose, x, y (m), heading (rad), with these standard deviations (m, m, rad)."""
        self.pose = pose.astype(np.float64)
        self.covariance: Floats = np.diag(np.square(deviations))
        """(3, 3) of x, y, heading."""
        self._strain_1_s = np.zeros(3)  # mean innovation for each second between frames
        self._interval_s = _TICK_S  # between the last two frames
        self._since_frame_s = 0.0
        self._blind_ways_m = np.zeros((2, 2))  # without frames: sums of the ways ahead and to the left, in columns
        self._turned_sd_rad = 0.0  # since the last frame, by wheels
        self._blind_m2 = np.zeros((2, 2))  # the part of the covariance that comes from these ways

    def predict(
        self,
        ahead_m: float,
        left_m: float,
        turn_rad: float,
        duration_s: float = _TICK_S,
        scale_sd: float = 0.0,
        turn_sd_rad: float = 0.0,
    ) -> None:
        """Moves the pose by the odometry of `duration_s`: a way in the robot's former frame, and a turn.

        Ways ahead and ways to the left are wrong by a share each, with the deviation `scale_sd`, which stays the same.
        Without frames, these errors grow with the whole way, and shrink if the robot drives back. So does a turn by the
        wheels, which has the deviation `turn_sd_rad` besides: wheels of different sizes turn a robot that drives ahead.
        """
        middle_rad = float(self.pose[2]) + turn_rad / 2
        axes = rotation(middle_rad)
        way_m = axes @ (ahead_m, left_m)
        self.pose = moved(self.pose, way_m, turn_rad)
        shift = np.array(((1.0, 0.0, -way_m[1]), (0.0, 1.0, way_m[0]), (0.0, 0.0, 1.0)))
        error_m, error_rad = motion_errors(math.hypot(ahead_m, left_m), turn_rad, duration_s)
        strain = self._strain_1_s * math.sqrt(_STRAIN_SHARE * duration_s * self._interval_s)
        noise = strain[:, None] * strain
        noise[_AXES, _AXES] += error_m**2, error_m**2, error_rad**2
        before_rad, self._turned_sd_rad = self._turned_sd_rad, self._turned_sd_rad + turn_sd_rad
        noise[2, 2] += self._turned_sd_rad**2 - before_rad**2
        self._since_frame_s += duration_s
        if self._since_frame_s > _BLIND_S:
            self._blind_ways_m += axes * (ahead_m, left_m)
            blind_m2 = scale_sd**2 * product(self._blind_ways_m, self._blind_ways_m.T)
            noise[:2, :2] += blind_m2 - self._blind_m2
            self._blind_m2 = blind_m2
        _, self.covariance = predict(_NO_ERROR, self.covariance, F=shift, Q=noise)

    def correct(self, pose: Floats, covariance: Floats, interval_s: float = _TICK_S) -> None:
        """Takes a measurement of the whole pose (3) with its covariance (3, 3), `interval_s` after the last one.

        Slipping wheels, or another robot that pushes, falsify the prediction in the same direction frame after frame.
        The mean of the last innovations therefore counts as an error of the next prediction. It lasts from frame to
        frame, so what it adds until then depends on the time between frames, not on the length of a tick.
        """
        self._interval_s = interval_s = max(interval_s, 1e-3)
        if self._since_frame_s > _BLIND_S:
            self._blind_ways_m, self._blind_m2 = np.zeros((2, 2)), np.zeros((2, 2))
        self._since_frame_s = self._turned_sd_rad = 0.0
        innovation = pose - self.pose
        innovation[2] = wrap_rad(float(innovation[2]))
        share = -math.expm1(-interval_s / _STRAIN_MEMORY_S)
        self._strain_1_s += share * (innovation / interval_s - self._strain_1_s)
        error, self.covariance = update(_NO_ERROR, self.covariance, innovation, R=covariance, H=_UNIT)
        self.pose = moved(self.pose, error[:2], float(error[2]))


def motion_errors(way_m: float, turn_rad: float, duration_s: float) -> tuple[float, float]:
    """Returns the standard deviations in m and rad of a motion by odometry that takes `duration_s`.

    Errors are independent from tick to tick. Their variances add up, so the length of a tick does not matter.
    """
    ticks = max(duration_s, 1e-3) / _TICK_S
    error_m = (_PATH_ERROR * way_m / ticks + _STANDING_M) * math.sqrt(ticks)
    return error_m, (_TURN_ERROR * abs(turn_rad) / ticks + _STANDING_RAD) * math.sqrt(ticks)


def moved(pose: Floats, way_m: Floats, turn_rad: float) -> Floats:
    """Returns the pose (3) shifted by a way (2) in the world frame and turned."""
    return np.array((pose[0] + way_m[0], pose[1] + way_m[1], wrap_rad(float(pose[2]) + turn_rad)))

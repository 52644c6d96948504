"""Kalman filter of a robot's pose: driven by odometry, corrected by what the lines say."""

import numpy as np
from filterpy.kalman import KalmanFilter

from procs.model.frames import Floats, rotation, wrap

_PATH_ERROR = 0.1  # of the way driven since the last frame: wheel scale, encoder noise, slip
_STANDING_M = 0.002
_TURN_ERROR = 0.03
_STANDING_RAD = 0.002
_STRAIN_MEMORY = 0.75  # of the mean innovation from frame to frame


class PoseFilter:
    """Error-state form: the pose is kept beside the filter, whose state is the small error of x, y and heading.

    So the heading needs no care in the filter's algebra.
    """

    def __init__(self, pose: Floats, deviations: tuple[float, float, float]) -> None:
        """`pose` is x, y (m), heading (rad); `deviations` their standard deviations."""
        self.pose = pose.astype(np.float64)
        self._filter = KalmanFilter(dim_x=3, dim_z=3)
        self._filter.P = np.diag(np.square(deviations))
        self._filter.H = np.eye(3)
        self._strain = np.zeros(3)

    @property
    def covariance(self) -> Floats:
        """(3, 3) of x, y, heading."""
        return np.asarray(self._filter.P)

    def predict(self, ahead_m: float, left_m: float, turn_rad: float) -> None:
        """The robot moved, by its odometry: in the frame it had before, and turned."""
        middle_rad = float(self.pose[2]) + turn_rad / 2
        way_m = rotation(middle_rad) @ (ahead_m, left_m)
        self.pose = moved(self.pose, way_m, turn_rad)
        shift = np.eye(3)
        shift[:2, 2] = -way_m[1], way_m[0]
        error_m = _PATH_ERROR * float(np.hypot(ahead_m, left_m)) + _STANDING_M
        error_rad = _TURN_ERROR * abs(turn_rad) + _STANDING_RAD
        noise = np.diag(np.square((error_m, error_m, error_rad))) + np.outer(self._strain, self._strain)
        self._filter.predict(F=shift, Q=noise)

    def correct(self, pose: Floats, covariance: Floats) -> None:
        """A measurement of the whole pose (3) with its covariance (3, 3).

        Wheels that slip, or another robot that pushes, make the prediction wrong frame after frame in the same
        direction; the mean of the last innovations is therefore taken for an error of the next prediction.
        """
        innovation = pose - self.pose
        innovation[2] = wrap(float(innovation[2]))
        self._strain += (1 - _STRAIN_MEMORY) * (innovation - self._strain)
        self._filter.update(innovation[:, None], R=covariance)
        error = self._filter.x[:, 0]
        self._filter.x = np.zeros((3, 1))
        self.pose = moved(self.pose, error[:2], float(error[2]))


def moved(pose: Floats, way_m: Floats, turn_rad: float) -> Floats:
    """The pose (3) shifted by a way (2) in the world frame and turned."""
    return np.array((pose[0] + way_m[0], pose[1] + way_m[1], wrap(float(pose[2]) + turn_rad)))

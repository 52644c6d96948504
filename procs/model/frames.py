"""Angles, and points with their uncertainty taken from the robot's frame to the world's."""

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]


def wrap(angle_rad: float) -> float:
    """Returns the same direction between -pi and pi."""
    return math.remainder(angle_rad, 2 * math.pi)


def rotation(angle_rad: float) -> Floats:
    """Matrix (2, 2) that turns vectors counter-clockwise."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, -sine], [sine, cosine]])


def to_world(pose: Floats, points_m: Floats) -> Floats:
    """Points (n, 2) of the robot frame in the world frame; `pose` is x, y (m) and heading (rad)."""
    return np.asarray(points_m @ rotation(float(pose[2])).T + pose[:2])


def covariance_to_world(
    pose: Floats, pose_covariance: Floats, points_m: Floats, covariances_m2: Floats
) -> tuple[Floats, Floats]:
    """Covariances (n, 2, 2) in the world frame of points (n, 2) that a robot sees, in two parts.

    The first part comes from the sight itself and is new in each frame, the second from the robot's own pose,
    whose error stays for a while and is shared by everything that the robot sees. `pose_covariance` (3, 3) is of
    x, y, heading.
    """
    turn = rotation(float(pose[2]))
    offsets_m = points_m @ turn.T
    by_pose = np.zeros((len(points_m), 2, 3))
    by_pose[:, 0, 0] = by_pose[:, 1, 1] = 1.0
    by_pose[:, 0, 2] = -offsets_m[:, 1]
    by_pose[:, 1, 2] = offsets_m[:, 0]
    return turn @ covariances_m2 @ turn.T, by_pose @ pose_covariance @ by_pose.transpose(0, 2, 1)

"""Rotations, and the transformation of points with their uncertainty from the robot frame to the world frame."""

import math

import numpy as np

from procs.model.algebra import Flags, Floats, Indices

__all__ = ["Flags", "Floats", "Indices", "rotation", "to_world"]


def rotation(angle_rad: float) -> Floats:
    """Returns the matrix (2, 2) that turns vectors counter-clockwise."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, -sine], [sine, cosine]])


def to_world(
    pose: Floats, pose_covariance: Floats, points_m: Floats, covariances_m2: Floats
) -> tuple[Floats, Floats, Floats]:
    """Transforms points (n, 2) that a robot sees to the world frame, with their covariances (n, 2, 2) in two parts.

    The first part comes from the sight itself and is independent from frame to frame. The second comes from the robot's
    own pose, whose error lasts for a while and is shared by everything that the robot sees.

    Args:
        pose: x, y (m) and heading (rad) of the robot.
        pose_covariance: (3, 3) of the pose.
        points_m: (n, 2), robot frame.
        covariances_m2: (n, 2, 2) of the sight, robot frame.

    Returns:
        Points (n, 2), the covariances of the sight (n, 2, 2), and those that the pose adds (n, 2, 2).
    """
    turn = rotation(float(pose[2]))
    offsets_m = points_m @ turn.T
    by_pose = np.zeros((len(points_m), 2, 3))
    by_pose[:, 0, 0] = by_pose[:, 1, 1] = 1.0
    by_pose[:, 0, 2] = -offsets_m[:, 1]
    by_pose[:, 1, 2] = offsets_m[:, 0]
    turned_m2 = turn @ covariances_m2 @ turn.T
    return offsets_m + pose[:2], turned_m2, by_pose @ pose_covariance @ by_pose.transpose(0, 2, 1)

"""Checks the covariances that messages state: not every matrix is a covariance."""

import math
from collections.abc import Sequence

from procs.model.geometry import plausible

_ROUNDING = 1e-6  # relative error that is tolerated; well above the rounding errors of matrix products


def is_covariance(matrix: Sequence[Sequence[float]]) -> bool:
    """Returns whether a matrix (2, 2) or (3, 3) is symmetric and positive semidefinite, with plausible values.

    A filter that used any other matrix as a covariance would end in NaN, and stay there.
    """
    for i in range(len(matrix)):
        if not (plausible(*matrix[i]) and matrix[i][i] >= 0.0):
            return False
        for j in range(i):
            most = matrix[i][i] * matrix[j][j]
            slack = _ROUNDING * most**0.5
            if abs(matrix[i][j] - matrix[j][i]) > slack or abs(matrix[i][j]) > most**0.5 + slack:
                return False
    return len(matrix) < 3 or _determinant(matrix) >= -_ROUNDING * matrix[0][0] * matrix[1][1] * matrix[2][2]


def is_positive(matrix: Sequence[Sequence[float]]) -> bool:
    """Returns whether a matrix (2, 2) is positive definite: any other is no covariance, or claims an exact value."""
    (xx, xy), (yx, yy) = matrix
    return xx > 0.0 and 0.0 < xx * yy - xy * yx < math.inf


def _determinant(matrix: Sequence[Sequence[float]]) -> float:
    (a, b, c), (d, e, f), (g, h, i) = matrix
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

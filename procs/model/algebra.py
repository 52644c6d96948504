"""Array operations whose last bits are the same on every machine; BLAS, behind `@`, picks kernels by the processor."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]


def product(rows: Floats, matrix: Floats) -> Floats:
    """Returns `rows @ matrix` for rows (n, k) and a small matrix (k, m)."""
    made: Floats = rows[:, :1] * matrix[0]
    for k in range(1, len(matrix)):
        made += rows[:, k : k + 1] * matrix[k]
    return made


def weighted_mean(values: Floats, weights: Floats) -> float:
    """Returns the mean of values (n) by weights (n) that do not sum up to zero."""
    return float((values * weights).sum() / weights.sum())


def median(values: Floats) -> float:
    """Returns the median of values (n); for few values, NumPy's own takes four times as long."""
    ordered, half = np.sort(values), len(values) // 2
    return float(ordered[half] if len(values) % 2 else (ordered[half - 1] + ordered[half]) / 2)

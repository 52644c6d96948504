"""Which matrices in messages can be covariances."""

import math

import numpy as np
import pytest

from procs.model.covariance import is_covariance


@pytest.mark.parametrize("size", [2, 3])
def test_products_of_matrices_are_covariances(size: int) -> None:
    rng = np.random.default_rng(1)
    for rank in range(1, size + 1):
        for _ in range(200):
            root = rng.standard_normal((size, rank)) * 10.0 ** rng.integers(-4, 2)
            assert is_covariance((root @ root.T).tolist())
    assert is_covariance(np.zeros((size, size)).tolist())


@pytest.mark.parametrize(
    "matrix",
    [
        [[1e-3, -1.0], [0.0, 1e-3]],
        [[1e-3, 1e-4], [0.0, 1e-3]],
        [[1.0, 2.0], [2.0, 1.0]],
        [[-1.0, 0.0], [0.0, -1.0]],
        [[math.nan, 0.0], [0.0, 1.0]],
        [[1.0, math.inf], [math.inf, 1.0]],
        [[1e300, 0.0], [0.0, 1.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1e-9]],
        [[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]],
    ],
)
def test_others_are_not(matrix: list[list[float]]) -> None:
    assert not is_covariance(matrix)


def test_matrices_that_pass_have_no_negative_direction() -> None:
    rng = np.random.default_rng(2)
    for _ in range(2000):
        size = int(rng.integers(2, 4))
        half = rng.uniform(-1.0, 1.0, (size, size))
        matrix = half + half.T + np.eye(size) * rng.uniform(0.0, 3.0)
        assert is_covariance(matrix.tolist()) == (np.linalg.eigvalsh(matrix)[0] >= 0.0)

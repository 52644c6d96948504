"""Library parts of the estimation: their identity, and the cost of their import."""

import subprocess
import sys

import pytest

LEAN = """
import sys
from procs.model.estimation import KalmanFilter, linear_sum_assignment
import procs.localization.localization
import procs.world_model.world_model
heavy = [name for name in ("scipy.stats", "scipy.optimize", "filterpy") if name in sys.modules]
assert not heavy, heavy
import filterpy.kalman
import scipy.optimize
assert filterpy.kalman.IMMEstimator and scipy.optimize.minimize
assert issubclass(KalmanFilter, object) and KalmanFilter(4, 2).P.shape == (4, 4)
assert linear_sum_assignment([[1.0, 0.0], [0.0, 1.0]])[1].tolist() == [1, 0]
assert isinstance(KalmanFilter(2, 1).log_likelihood, float)
"""

ORDINARY = """
import filterpy.kalman
from procs.model.estimation import KalmanFilter
assert KalmanFilter is filterpy.kalman.KalmanFilter
"""


def run(program: str) -> None:
    subprocess.run([sys.executable, "-W", "ignore", "-c", program], check=True, timeout=120)


@pytest.mark.slow
def test_estimation_imports_no_statistics_and_no_optimizers() -> None:
    run(LEAN)


@pytest.mark.slow
def test_already_imported_library_is_used() -> None:
    run(ORDINARY)

"""What estimation takes out of filterpy and scipy: the same as in the whole libraries, at a fraction of the imports."""

import subprocess
import sys

SAME_FILTER = """
import numpy as np
from procs.estimation.lean_imports import KalmanFilter as ours
from filterpy.kalman import KalmanFilter as theirs

assert ours is not theirs
rng = np.random.default_rng(1)
mine, other = filters = [made(dim_x=4, dim_z=2) for made in (ours, theirs)]
for each in filters:
    each.H = np.eye(2, 4)
for _ in range(20):
    noise, seen = rng.random((4, 4)), rng.random((2, 1))
    for each in filters:
        each.predict(F=np.eye(4) + np.eye(4, k=2) * 0.1, Q=noise @ noise.T)
        each.update(seen)
assert mine.x.tobytes() == other.x.tobytes()
assert mine.P.tobytes() == other.P.tobytes()
assert mine.log_likelihood == other.log_likelihood
"""

SAME_ASSIGNMENT = """
import numpy as np
from procs.estimation.lean_imports import linear_sum_assignment as ours
from scipy.optimize import linear_sum_assignment as theirs

costs = np.random.default_rng(1).random((5, 8))
assert np.array_equal(ours(costs), theirs(costs))
"""

IMPORTED_BEFORE = """
from filterpy.kalman import KalmanFilter
from scipy.optimize import linear_sum_assignment
from procs.estimation import lean_imports

assert lean_imports.KalmanFilter is KalmanFilter
assert lean_imports.linear_sum_assignment is linear_sum_assignment
"""

LAID_OUT_OTHERWISE = """
from pathlib import Path
from procs.estimation import lean_imports

lean_imports._folder_of = lambda library: Path("/nowhere")
whole = lean_imports.load_kalman_filter(), lean_imports.load_linear_sum_assignment()
from filterpy.kalman import KalmanFilter
from scipy.optimize import linear_sum_assignment

assert whole == (KalmanFilter, linear_sum_assignment)
"""


def in_a_new_process(code: str) -> str:
    """Runs Python code that imports what it wants; returns what it printed."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_components_of_estimation_import_neither_library() -> None:
    imported = in_a_new_process("import sys, procs.world_model, procs.localization; print(*sys.modules)").split()
    assert "procs.estimation.robot_tracks" in imported
    assert not {"filterpy", "filterpy.stats", "scipy", "scipy.optimize"} & set(imported)


def test_filter_alone_computes_the_very_bytes_of_the_library() -> None:
    in_a_new_process(SAME_FILTER)


def test_assignment_alone_is_the_library_s() -> None:
    in_a_new_process(SAME_ASSIGNMENT)


def test_library_that_somebody_has_imported_is_taken_as_it_is() -> None:
    in_a_new_process(IMPORTED_BEFORE)


def test_library_that_is_laid_out_otherwise_is_imported_whole() -> None:
    in_a_new_process(LAID_OUT_OTHERWISE)

"""The parts of filterpy and scipy that estimation uses: Kalman filter and assignment.

`import filterpy` and `import scipy.optimize` take more than a second at each start, mostly for `scipy.stats`.
"""

import sys
from typing import Any

from procs.model.submodules import bare


def _logpdf(*values: Any, **named: Any) -> Any:
    """Computes the logarithm of a density, which filterpy needs for likelihoods only."""
    from filterpy.stats import logpdf

    return logpdf(*values, **named)


with bare("filterpy", "filterpy.kalman", "filterpy.common", "filterpy.stats"):
    if not hasattr(sys.modules["filterpy.stats"], "logpdf"):
        from filterpy.common import helpers

        vars(sys.modules["filterpy.common"]).update(vars(helpers))
        vars(sys.modules["filterpy.stats"])["logpdf"] = _logpdf
    from filterpy.kalman.kalman_filter import KalmanFilter, predict, update

with bare("scipy.optimize"):
    from scipy.optimize._lsap import linear_sum_assignment

__all__ = ["KalmanFilter", "linear_sum_assignment", "predict", "update"]

"""The two things that estimation needs of filterpy and scipy, loaded without the rest of these libraries.

`filterpy.kalman` and `scipy.optimize` import hundreds of modules beside them: more than a second at each start.
A Kalman filter and the assignment problem need none of those, so here their files are executed alone. Where a library
has been imported already, or is laid out otherwise than expected, its ordinary import takes place.
"""

import sys
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any


def load_kalman_filter() -> Any:
    """filterpy's class."""
    try:
        return _kalman_filter_alone()
    except (ImportError, OSError, AttributeError):
        from filterpy.kalman import KalmanFilter

        return KalmanFilter


def load_linear_sum_assignment() -> Any:
    """scipy's function, which lives in an extension module of its own."""
    try:
        folder = _folder_of("scipy") / "optimize"
        return _executed("scipy.optimize._lsap", folder / f"_lsap{EXTENSION_SUFFIXES[0]}").linear_sum_assignment
    except (ImportError, OSError, AttributeError):
        from scipy.optimize import linear_sum_assignment

        return linear_sum_assignment


def _kalman_filter_alone() -> Any:
    folder = _folder_of("filterpy")
    stats = ModuleType("filterpy.stats")
    stats.logpdf = _logpdf  # type: ignore[attr-defined]
    stand_ins = {"filterpy.stats": stats, "filterpy.common": _executed("helpers", folder / "common" / "helpers.py")}
    sys.modules.update(stand_ins)
    try:
        return _executed("filterpy.kalman.kalman_filter", folder / "kalman" / "kalman_filter.py").KalmanFilter
    finally:
        for name in stand_ins:
            del sys.modules[name]  # who imports filterpy later gets all of it


def _logpdf(*values: Any, **named: Any) -> Any:
    from filterpy.stats import logpdf  # scipy.stats, for who asks for a likelihood

    return logpdf(*values, **named)


def _folder_of(library: str) -> Path:
    """Where a library is installed that nobody has imported yet.

    Raises:
        ImportError: somebody has, or it is not there.
    """
    spec = find_spec(library)
    if library in sys.modules or spec is None or not spec.submodule_search_locations:
        raise ImportError(f"{library}: imported already, or no folder")
    return Path(spec.submodule_search_locations[0])


def _executed(name: str, file: Path) -> ModuleType:
    """A module from its file; Python's table of modules does not learn of it.

    Raises:
        ImportError: it is not there.
    """
    spec = spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file}: no module")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


KalmanFilter = load_kalman_filter()
linear_sum_assignment = load_linear_sum_assignment()

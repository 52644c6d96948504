"""Dependencies of a run's results besides its launch file: the application's modules and the BLAS kernel."""

import ctypes
import hashlib
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

from fwk.clock import wall_us
from fwk.model.plan import ModulePlan, Plan

_KEPT = ("fwk", "lcmtypes")
"""Packages of the framework and of generated types, which belong to no application."""
_DIGITS = 16
_SETTLED_US = 1_000_000
"""Age of a file's last change from which a further change is sure to have another time."""
_KERNEL_SYMBOLS = [f"{prefix}openblas_get_corename{suffix}" for prefix in ("scipy_", "") for suffix in ("64_", "")]
_kernel: list[str] = []
"""Kernels of the libraries that were loaded when it was first asked for; empty as long as there was none."""


def imported_modules(component_modules: Iterable[str], folders: Sequence[str]) -> dict[str, ModulePlan]:
    """Returns the application's modules that this process has imported, by name.

    Args:
        component_modules: modules of the components, perhaps with `:Class`; everything in their packages belongs to
            the application.
        folders: folders of the application; everything in them belongs to it, except libraries.
    """
    packages = {module.partition(":")[0].partition(".")[0] for module in component_modules} - {*_KEPT}
    prefixes = tuple(f"{Path(folder).resolve()}/" for folder in folders)
    found = {}
    for name, module in list(sys.modules.items()):
        file, top = getattr(module, "__file__", None), name.partition(".")[0]
        if not file or top in _KEPT:
            continue
        if top in packages or (prefixes and file.startswith(prefixes) and "site-packages" not in file):
            found[name] = file
    return {name: ModulePlan(file, hash_of(file)) for name, file in sorted(found.items())}


def changed_modules(plan: Plan) -> dict[str, str]:
    """Returns the modules of a recorded run that differ here, by name, each with the difference.

    The folders of the plan must be in `sys.path`. A module with the same content in another place is the same.
    """
    changed = {}
    for name, before in plan.modules.items():
        file = _file_of(name)
        if not file:
            changed[name] = f"{before.file} is missing"
        elif hash_of(file) != before.sha256:
            changed[name] = f"{file} was changed" if file == before.file else f"{before.file} ran; here it is {file}"
    return changed


def hash_of_module(name: str) -> str:
    """Returns the hash of a module's file here; empty if there is no such module."""
    file = _file_of(name)
    return hash_of(file) if file else ""


def different_modules(plans: tuple[Plan, Plan]) -> list[str]:
    """Returns the names of the modules that both of two runs imported, but with different content."""
    first, second = plans[0].modules, plans[1].modules
    return [name for name in first if name in second and first[name].sha256 != second[name].sha256]


def blas_kernel() -> str:
    """Returns the name of the processor-specific kernel of the loaded OpenBLAS; empty if none is loaded.

    Kernels differ in the last bits of matrix products, so the bytes of a run depend on the kernel.
    """
    if not _kernel:  # a loaded library stays, and with it its kernel
        _kernel.extend(_loaded_kernel())
    return _kernel[0] if _kernel else ""


def _loaded_kernel() -> Iterator[str]:
    with open("/proc/self/maps") as maps:
        libraries = {line.split(maxsplit=5)[5].strip() for line in maps if "openblas" in line}
    for library in sorted(libraries):
        loaded = ctypes.CDLL(library)
        for symbol in _KERNEL_SYMBOLS:
            if hasattr(loaded, symbol):
                ask = getattr(loaded, symbol)
                ask.restype = ctypes.c_char_p
                yield str(ask().decode())


def other_kernel(names: tuple[str, str], kernels: tuple[str, str]) -> str:
    """Returns a sentence if two sides ran with different BLAS kernels; empty if not, or if one is unknown."""
    if not all(kernels) or kernels[0] == kernels[1]:
        return ""
    return (
        f"{names[0]} ran with the BLAS kernel {kernels[0]}, {names[1]} with {kernels[1]}: "
        "results of matrix operations may differ in their last digits; OPENBLAS_CORETYPE chooses a kernel"
    )


def _file_of(module: str) -> str:
    loaded = sys.modules.get(module)
    if loaded is not None:
        return getattr(loaded, "__file__", None) or ""
    try:
        spec = find_spec(module)
    except (ImportError, ValueError):
        return ""
    return spec.origin or "" if spec else ""


def hash_of(file: str) -> str:
    """Returns the beginning of the hash of a file's content; empty if there is no such file."""
    try:
        found = os.stat(file)
        if wall_us() - max(found.st_mtime_ns, found.st_ctime_ns) // 1000 > _SETTLED_US:
            return _hash_of_version(file, found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns)
        return _hash_of_content(file)
    except OSError:  # deleted since it was imported
        return ""


@lru_cache(maxsize=4096)
def _hash_of_version(file: str, *_version: int) -> str:
    return _hash_of_content(file)


def _hash_of_content(file: str) -> str:
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()[:_DIGITS]

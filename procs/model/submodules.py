"""Imports single modules of large libraries, without everything that the libraries import themselves."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import ModuleSpec
from importlib.util import find_spec, module_from_spec


@contextmanager
def bare(*packages: str) -> Iterator[None]:
    """Imports inside the `with` block do not run the `__init__` of these packages, given with parents first.

    Packages that are imported already stay as they are. After the block the bare ones are gone, so that an ordinary
    import gives all of the library.

    Raises:
        ModuleNotFoundError: a package is not installed.
    """
    missing = [name for name in packages if name not in sys.modules]
    before = set(sys.modules)
    try:
        for name in missing:
            spec = find_spec(name)
            if spec is None or spec.submodule_search_locations is None:
                raise ModuleNotFoundError(f"package '{name}' is not installed; the project needs it", name=name)
            package = module_from_spec(ModuleSpec(name, None, is_package=True))
            package.__path__ = list(spec.submodule_search_locations)
            sys.modules[name] = package
        yield
    finally:
        for name in set(sys.modules) - before:
            if any(name == package or name.startswith(f"{package}.") for package in missing):
                del sys.modules[name]

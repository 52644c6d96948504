"""Finds the class that a launch file names with `use`, such as `drivers.wheels`."""

import inspect
import pkgutil
import re
import sys
import sysconfig
import traceback
from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType, TracebackType

from fwk.component.component import Component
from fwk.component.declaration import Declaration, declaration
from fwk.component.port import DeclarationError
from fwk.model.errors import hint
from fwk.plan.packages import component_packages

_USE = re.compile(r"[A-Za-z_]\w*(\.\w+)*(:[A-Za-z_]\w*)?", re.ASCII)


class UnusableError(Exception):
    """What `use:` names cannot be used; says why and what would be right."""


def find_class(use: str, folders: Sequence[str] = ()) -> Declaration:
    """Imports a module and reads the class of its one component, or of the one named behind a colon.

    `folders` are searched for the nearest name when there is no such module.

    Raises:
        UnusableError: no such module or class, several components, or the module or the class has a mistake.
    """
    if not _USE.fullmatch(use):
        raise UnusableError(f"'{use}' is not a module; write it as in Python: drivers.wheels, or drivers.wheels:Wheels")
    name, _, wanted = use.partition(":")
    module = imported(name, folders)
    try:
        return declaration(_named(module, wanted) if wanted else _only(module))
    except DeclarationError as error:
        raise UnusableError(str(error)) from error


def find_object(use: str, folders: Sequence[str] = ()) -> object:
    """What `module:name` stands for.

    Raises:
        UnusableError: no such module or name.
    """
    name, _, wanted = use.partition(":")
    if not wanted or not _USE.fullmatch(use):
        raise UnusableError(f"'{use}' is no function; write module:function")
    module = imported(name, folders)
    if not hasattr(module, wanted):
        raise UnusableError(f"module '{name}' has no '{wanted}'; {hint(wanted, _public(module))}")
    return getattr(module, wanted)


def imported(name: str, folders: Sequence[str] = ()) -> ModuleType:
    """Imports a module.

    Raises:
        UnusableError: there is no such module, or its import fails; then with the line of the file that is to blame.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise UnusableError(f"no module '{name}'; {hint(name, _neighbours(name, folders))}") from error
        raise UnusableError(_failure(name, error)) from error
    except (Exception, SystemExit) as error:
        raise UnusableError(_failure(name, error)) from error


def _failure(name: str, error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.filename:
        return f"cannot import '{name}': {error.msg} ({_shown(error.filename)}:{error.lineno})"
    reason = "".join(traceback.format_exception_only(error)).strip().splitlines()[-1]
    return f"cannot import '{name}': {reason}{_blamed(error.__traceback__)}"


def _blamed(trace: TracebackType | None) -> str:
    """The innermost line that belongs to no library."""
    libraries = (sysconfig.get_path("stdlib"), sysconfig.get_path("purelib"), sysconfig.get_path("platlib"))
    here = str(Path(__file__).parent)
    for frame in reversed(traceback.extract_tb(trace)):
        if not frame.filename.startswith(("<", here, *libraries)):
            return f" ({_shown(frame.filename)}:{frame.lineno})"
    return ""


def _shown(file: str) -> str:
    path = Path(file)
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else file


def _neighbours(name: str, folders: Sequence[str]) -> list[str]:
    """Modules that are where a missing one should be."""
    parent = name.rpartition(".")[0]
    while parent:
        try:
            spec = find_spec(parent)
        except (ImportError, ValueError):
            spec = None
        if spec and spec.submodule_search_locations:
            return [f"{parent}.{found.name}" for found in pkgutil.iter_modules(spec.submodule_search_locations)]
        parent = parent.rpartition(".")[0]
    packages = [path.name for folder in folders for path in Path(folder).glob("*/") if any(path.glob("*.py"))]
    inside = [
        f"{package}.{found.name}"
        for package in {*packages, *component_packages()}
        for found in pkgutil.iter_modules([f"{folder}/{package}" for folder in (*folders, *sys.path)])
    ]
    return [found.name for found in pkgutil.iter_modules(list(folders))] + inside


def _public(module: ModuleType) -> list[str]:
    return [name for name in vars(module) if not name.startswith("_")]


def components_in(module: ModuleType) -> dict[str, type[Component]]:
    """The components that a module defines, by name."""
    return {
        name: value
        for name, value in vars(module).items()
        if inspect.isclass(value) and issubclass(value, Component) and value.__module__ == module.__name__
        if not name.startswith("_")
    }


def _only(module: ModuleType) -> type[Component]:
    found = components_in(module)
    if len(found) == 1:
        return next(iter(found.values()))
    if not found:
        raise UnusableError(f"module '{module.__name__}' defines no component; derive a class from fwk.Component")
    which = " or ".join(f"{module.__name__}:{name}" for name in found)
    raise UnusableError(f"module '{module.__name__}' defines several components; say which: {which}")


def _named(module: ModuleType, wanted: str) -> type[Component]:
    found = getattr(module, wanted, None)
    if found is None:
        known = components_in(module)
        raise UnusableError(f"module '{module.__name__}' has no component '{wanted}'; {hint(wanted, known)}")
    if not inspect.isclass(found) or not issubclass(found, Component):
        raise UnusableError(f"{module.__name__}:{wanted} is no component; derive it from fwk.Component")
    return found

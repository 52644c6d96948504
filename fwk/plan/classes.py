"""Finds the class that a launch file names with `use`, such as `drivers.wheels`."""

import inspect
import os
import re
import sys
import sysconfig
import traceback
from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType, TracebackType

from pydantic import PydanticUserError

from fwk.component import program
from fwk.component.component import Component
from fwk.component.declaration import Declaration, declaration
from fwk.component.port import DeclarationError
from fwk.model.errors import hint
from fwk.plan.packages import component_packages

INSTALLED = Path(__file__).resolve().parents[2]
"""Folder of `fwk` and of the installed packages of components."""
_DEPTH = 2  # folders below a folder of modules that are searched for a module to propose
_FILES_MAX = 200  # files of a folder that are searched
_USE = re.compile(r"[A-Za-z_]\w*(\.\w+)*(:[A-Za-z_]\w*)?", re.ASCII)


class UnusableError(Exception):
    """The value of `use:` cannot be used; the text gives the reason and what would be right."""


def find_class(use: str, folders: Sequence[str] = ()) -> Declaration:
    """Imports a module and reads the class of its one component, or of the one named behind a colon.

    `folders` are searched for the nearest name if the module does not exist.

    Raises:
        UnusableError: the module or class does not exist or has a mistake, or the module has several components.
    """
    if use.startswith(f"{program.MODULE}:"):
        return _program(use.partition(":")[2])
    if not _USE.fullmatch(use):
        raise UnusableError(f"'{use}' is not a module; write it as in Python: drivers.wheels, or drivers.wheels:Wheels")
    name, _, wanted = use.partition(":")
    module = imported(name, folders)
    try:
        return declaration(_named(module, wanted) if wanted else _only(module))
    except DeclarationError as error:
        raise UnusableError(str(error)) from error


def _program(name: str) -> Declaration:
    """Returns the declaration of a program of the launch file."""
    try:
        return declaration(getattr(program, name))
    except (AttributeError, DeclarationError) as error:
        raise UnusableError(str(error).removeprefix(f"{program.MODULE}.")) from error


def find_object(use: str, folders: Sequence[str] = ()) -> object:
    """Returns the object that `module:name` names.

    Raises:
        UnusableError: the module or name does not exist.
    """
    name, _, wanted = use.partition(":")
    if not wanted or not _USE.fullmatch(use):
        raise UnusableError(f"'{use}' is not a function; write module:function")
    module = imported(name, folders)
    if not hasattr(module, wanted):
        raise UnusableError(f"module '{name}' has no '{wanted}'; {hint(wanted, _public(module))}")
    return getattr(module, wanted)


def imported(name: str, folders: Sequence[str] = ()) -> ModuleType:
    """Imports a module.

    Raises:
        UnusableError: the module does not exist, or its import fails; the text names the line that fails.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise UnusableError(f"no module '{name}'; {_missing(name, folders)}") from error
        raise UnusableError(_failure(name, error)) from error
    except (Exception, SystemExit) as error:
        raise UnusableError(_failure(name, error)) from error


def _failure(name: str, error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.filename:
        return f"cannot import '{name}': {error.msg} ({_shown(error.filename)}:{error.lineno})"
    package = error.name or "" if isinstance(error, ModuleNotFoundError) else ""
    if package.startswith("lcmtypes."):
        file = f"{package.replace('.', '/', 1)}.lcm"
        return f"cannot import '{name}': no types '{package}'; they come from {file}{_blamed(error.__traceback__)}"
    reason = _setting_mistake(error) or "".join(traceback.format_exception_only(error)).strip().splitlines()[-1]
    return f"cannot import '{name}': {reason}{_blamed(error.__traceback__)}"


def _setting_mistake(error: BaseException) -> str:
    """Returns the mistake of a settings class with a type that no file can hold, such as an array."""
    found = isinstance(error, PydanticUserError) and re.search(
        r"schema for (?:<class '([^']*)'>|(\S+?)\.? )", str(error)
    )
    if not found:
        return ""
    right = "use numbers, text, bool, a list or tuple of them, an Enum, or a Config"
    return f"a setting cannot be of type {found[1] or found[2]}; {right}"


def _blamed(trace: TracebackType | None) -> str:
    """Returns the innermost line of a traceback outside the libraries."""
    libraries = (sysconfig.get_path("stdlib"), sysconfig.get_path("purelib"), sysconfig.get_path("platlib"))
    here = str(Path(__file__).parent)
    for frame in reversed(traceback.extract_tb(trace)):
        if not frame.filename.startswith(("<", here, *libraries)):
            return f" ({_shown(frame.filename)}:{frame.lineno})"
    return ""


def _shown(file: str) -> str:
    path = Path(file)
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else file


def _missing(name: str, folders: Sequence[str]) -> str:
    """Returns a hint for a module that does not exist: a similar name, or the author's own modules."""
    if reason := _hidden(name):
        return reason
    own, installed = _modules_in(folders), _modules_in([str(INSTALLED)])
    near = hint(name, [*own, *installed], " ")
    return near if near != " " else hint(name, _beside(name, own) or own or _beside(name, installed) or installed)


def _beside(name: str, modules: Sequence[str]) -> list[str]:
    """Returns the modules in the package of a missing one, or in the nearest package around it that exists."""
    package = name.rpartition(".")[0]
    while package:
        if found := [module for module in modules if module.startswith(f"{package}.")]:
            return found
        package = package.rpartition(".")[0]
    return []


def _modules_in(folders: Sequence[str]) -> list[str]:
    """Returns the names of modules in folders and their packages; of installed ones, those of announced packages."""
    found: set[str] = set()
    for folder in folders:
        starts = [f"{folder}/{name}" for name in component_packages()] if folder == str(INSTALLED) else [folder]
        for start in starts:
            found |= {".".join(Path(os.path.relpath(file, folder)).parts)[:-3] for file in _python_files(start, _DEPTH)}
    return sorted(found)


def _python_files(folder: str, depth: int) -> Iterator[str]:
    """Returns the modules of a folder except tests, and of folders below with as few files as packages have."""
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)[:_FILES_MAX]
    except OSError:
        return
    for entry in entries:
        stem = entry.name.removesuffix(".py")
        if stem.isidentifier() and stem != entry.name and stem != "__init__":
            if not stem.startswith("test_") and stem != "conftest":
                yield entry.path
        elif depth and entry.name.isidentifier() and entry.is_dir():
            yield from _python_files(entry.path, depth - 1)


def _hidden(name: str) -> str:
    """Returns the message that an `__init__.py` of the author hides an installed package; empty if none does."""
    package = name.partition(".")[0]
    file = getattr(sys.modules.get(package), "__file__", None)
    if package not in component_packages() or not file or Path(file).is_relative_to(INSTALLED):
        return ""
    if not any((INSTALLED / name.replace(".", "/")).with_suffix(suffix).exists() for suffix in (".py", "")):
        return ""
    return f"{_shown(file)} hides the installed package '{package}'; remove this file to use modules of both"


def _public(module: ModuleType) -> list[str]:
    return [name for name in vars(module) if not name.startswith("_")]


def components_in(module: ModuleType) -> dict[str, type[Component]]:
    """Returns the component classes that a module defines, by name."""
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
    raise UnusableError(f"module '{module.__name__}' defines several components; name one: {which}")


def _named(module: ModuleType, wanted: str) -> type[Component]:
    found = getattr(module, wanted, None)
    if found is None:
        known = components_in(module)
        raise UnusableError(f"module '{module.__name__}' has no component '{wanted}'; {hint(wanted, known)}")
    if not inspect.isclass(found) or not issubclass(found, Component):
        raise UnusableError(f"{module.__name__}:{wanted} is not a component; derive it from fwk.Component")
    return found

"""Finds the views and pages that projects add to the console."""

import sys
from collections.abc import Iterable, Sequence
from fnmatch import filter as matching
from importlib import import_module
from importlib.metadata import entry_points
from inspect import isabstract
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from fwk.web.view import Page, View

GROUP = "fwk.web"
"""Entry-point group; each entry point in it names a module with subclasses of `View` and `Page`."""
E = TypeVar("E", View, Page)


class ExtensionError(Exception):
    """A module with views and pages cannot be used; the text names it and the reason."""


class Extensions:
    """Views and pages of the modules that installed distributions announce, and of further ones.

    Raises:
        ExtensionError: a module cannot be imported, has neither views nor pages, or has one that lacks a method.
    """

    def __init__(self, modules: Sequence[str] = (), folder: Path | None = None) -> None:
        if modules and folder:
            sys.path.insert(0, str(folder.resolve()))
        announced = sorted({entry.value for entry in entry_points(group=GROUP)})
        found = [_imported(name) for name in dict.fromkeys((*announced, *modules))]
        made = [_made(kind) for module in found for kind in _classes(module)]
        self.views = [each for each in made if isinstance(each, View)]
        self.pages = [each for each in made if isinstance(each, Page)]

    def views_for(self, channels: Iterable[str]) -> list[View]:
        """Returns the views for a run with these channels."""
        return _offered(self.views, list(channels))

    def pages_for(self, channels: Iterable[str]) -> list[Page]:
        """Returns the pages for a run with these channels."""
        return _offered(self.pages, list(channels))


def _offered(made: list[E], channels: list[str]) -> list[E]:
    return [each for each in made if all(matching(channels, pattern) for pattern in each.needs)]


def _imported(name: str) -> ModuleType:
    try:
        module = import_module(name)
    except Exception as error:
        raise ExtensionError(f"{name}: cannot be imported: {type(error).__name__}: {error}") from error
    if not _classes(module):
        raise ExtensionError(f"{name}: has neither a subclass of fwk.web.View nor one of fwk.web.Page")
    return module


def _made(kind: type[Any]) -> View | Page:
    if isabstract(kind):
        missing = ", ".join(sorted(kind.__abstractmethods__))
        raise ExtensionError(f"{kind.__module__}: class {kind.__name__} does not define {missing}")
    made: View | Page = kind()
    return made


def _classes(module: ModuleType) -> list[type[Any]]:
    """Returns the views and pages that a module defines."""
    return [
        each
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, (View, Page)) and each.__module__ == module.__name__
    ]

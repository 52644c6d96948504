"""Packages of components that installed distributions announce."""

from functools import cache
from importlib.metadata import entry_points

GROUP = "fwk.components"
"""Entry-point group; each entry point in it names a package whose modules define components."""


@cache
def component_packages() -> tuple[str, ...]:
    """Returns the names of the announced packages, sorted."""
    return tuple(sorted({entry.value for entry in entry_points(group=GROUP)}))

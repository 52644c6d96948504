"""Finds the components of `procs`: a new component takes part in the conformance tests by existing."""

from collections.abc import Iterator
from functools import cache
from importlib import import_module
from inspect import isabstract
from pathlib import Path

from fwk import Component
from fwk.component.declaration import declaration
from fwk.model.plan import ComponentPlan
from fwk.plan.classes import components_in
from fwk.plan.load import LaunchOptions, load_plan

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "launch"
FILES = ("frames.yaml", "vision.yaml", "soccer-percepts.yaml", "soccer.yaml", "kidnapped.yaml")  # preferred ones first


def discovered() -> list[type[Component]]:
    """Returns the component classes of `procs` that a launch file can use, in the order of their modules."""
    found = [each for module in _modules() for each in components_in(import_module(module)).values()]
    return [each for each in found if not isabstract(each)]


def _modules() -> Iterator[str]:
    for path in sorted((ROOT / "procs").rglob("*.py")):
        yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def label(component: type[Component]) -> str:
    """Returns the test id of a component class, such as `world_model.ball_spot`."""
    return component.__module__.removeprefix("procs.")


def usage(component: type[Component]) -> tuple[str, ComponentPlan] | None:
    """Returns the first launch file that starts the component with all its needs met, and its index in that plan.

    A port for many instances needs two of them if any launch file has two. None if no launch file suits.
    """
    found = [each for each in _usages() if (each[1].module, each[1].class_name) == _key(component)]
    each_ports = [port.attribute for port in declaration(component).ports if port.each]
    full = [use for use in found if all(len(use[1].channels[attribute]) > 1 for attribute in each_ports)]
    return next(iter([*full, *found]), None)


def _key(component: type[Component]) -> tuple[str, str]:
    return component.__module__, component.__name__


@cache
def _usages() -> list[tuple[str, ComponentPlan]]:
    plans = [(file, load_plan(str(LAUNCH / file), LaunchOptions())) for file in FILES]
    return [(file, each) for file, plan in plans for each in plan.components if each.start]

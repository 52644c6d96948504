"""Finds the components of `procs`: a new component takes part in the conformance tests by existing."""

from collections.abc import Iterator
from functools import cache
from importlib import import_module
from inspect import isabstract
from pathlib import Path

from fwk import Component
from fwk.model.plan import ComponentPlan
from fwk.plan.classes import components_in
from fwk.plan.load import LaunchOptions, load_plan

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "launch"
FILES = ("frames.yaml", "vision.yaml", "soccer.yaml")  # small ones first


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
    """Returns the first launch file that contains the component, and its place in that plan; None without one."""
    return _usages().get((component.__module__, component.__name__))


@cache
def _usages() -> dict[tuple[str, str], tuple[str, ComponentPlan]]:
    found: dict[tuple[str, str], tuple[str, ComponentPlan]] = {}
    for file in FILES:
        for each in load_plan(str(LAUNCH / file), LaunchOptions()).components:
            found.setdefault((each.module, each.class_name), (file, each))
    return found

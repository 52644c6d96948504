"""Who depends on whom: what has to run before a component starts, and who has to leave before it is unloaded."""

from collections.abc import Sequence
from importlib import import_module

from fwk.component import declaration
from fwk.plan.model import ComponentPlan, Plan


def needed_by(plan: Plan) -> dict[int, set[int]]:
    """Component to those that it needs: what the launch file says, and the vision masters of its images."""
    writers = {channel.name: channel.writer for channel in plan.channels if channel.images}
    return {
        component.index: {
            *component.needs,
            *(writers[channel] for channel in _images(component) if writers.get(channel, -1) >= 0),
        }
        for component in plan.components
    }


def with_needs(chosen: Sequence[int], needs: dict[int, set[int]]) -> list[int]:
    """These components and everything that they need, in the order of the plan."""
    found: set[int] = set()
    waiting = list(chosen)
    while waiting:
        index = waiting.pop()
        if index not in found:
            found.add(index)
            waiting += sorted(needs[index])
    return sorted(found)


def users_of(index: int, needs: dict[int, set[int]]) -> list[int]:
    """Those that need a component."""
    return [user for user, needed in needs.items() if index in needed]


def _images(component: ComponentPlan) -> list[str]:
    declared = declaration(getattr(import_module(component.module), component.class_name))
    return [name for port in declared.ports if port.kind == "image" for name in component.channels[port.attribute]]

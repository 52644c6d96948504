"""Needs and dependents: components that must run before another starts, or stop before another is unloaded."""

from collections.abc import Callable, Sequence

from fwk.model.plan import ComponentPlan


def with_needs(chosen: Sequence[int], components: Sequence[ComponentPlan]) -> list[int]:
    """Returns these components and all that they need, in the order of the plan."""
    return _closure(chosen, lambda index: components[index].needs)


def with_users(chosen: Sequence[int], components: Sequence[ComponentPlan]) -> list[int]:
    """Returns these components and all their dependents, in the order of the plan."""
    return _closure(chosen, lambda index: users_of(index, components))


def users_of(index: int, components: Sequence[ComponentPlan]) -> list[int]:
    """Returns the components that need a component."""
    return [component.index for component in components if index in component.needs]


def _closure(chosen: Sequence[int], next_to: Callable[[int], Sequence[int]]) -> list[int]:
    found: set[int] = set()
    waiting = list(chosen)
    while waiting:
        index = waiting.pop()
        if index not in found:
            found.add(index)
            waiting += next_to(index)
    return sorted(found)

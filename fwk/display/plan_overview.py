"""Describes a plan in a few lines."""

import json

from fwk.clock import US_PER_S
from fwk.model.plan import Plan


def overview(plan: Plan) -> list[str]:
    """Sums a plan up in a few lines."""
    parts = [
        counted(len(plan.components), "component"),
        counted(len(plan.channels), "channel"),
        counted(len(plan.hosts), "process", "processes"),
        counted(len(plan.stages), "stage"),
        f"{US_PER_S / plan.period_us:g} ticks/s",
    ]
    changed = [
        f"{component.name}.{key} = {as_typed(value_at(component.config, key))} ({origin})"
        for component in plan.components
        for key, origin in component.origins.items()
        if origin == "--set" or ".host.yaml:" in origin
    ]
    return [f"{plan.name}: {', '.join(parts)}", *changed]


def value_at(config: object, dotted: str) -> object:
    """Returns the setting with that dotted name."""
    for key in dotted.split("."):
        config = config[key] if isinstance(config, dict) else None
    return config


def as_typed(value: object) -> str:
    """Returns a value as people type it in files and options: `null`, `true`, `[1, 2]`."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def counted(number: int, one: str, many: str = "") -> str:
    """Returns a number with its noun in the right form."""
    return f"{number} {one if number == 1 else many or f'{one}s'}"


def fewer_processes(plan: Plan, most: int | None = None) -> str:
    """Returns the option of `fwk-launch` with which the plan needs fewer processes, or else fewer components.

    With `most`, `--hosting robot` is chosen only if it needs no more processes than that.
    """
    hosts = len(plan.hosts)
    namespaces = len({component.name.rpartition("/")[0] for component in plan.components})
    fewer = namespaces < hosts and (most is None or namespaces <= most)
    return "--hosting robot" if fewer else "--hosting single" if hosts > 1 else "--only NAME..."

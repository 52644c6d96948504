"""Systems in memory of the components of a launch file."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from importlib import import_module
from itertools import takewhile
from typing import Any

from fwk.component.declaration import declaration
from fwk.lcm.messages import type_named
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.service_channels import service_of
from fwk.plan.load import LaunchOptions, load_plan
from fwk.testing.memory import MemorySystem


@lru_cache(maxsize=8)
def launch_plan(file: str, sets: tuple[str, ...] = ()) -> Plan:
    """Returns the checked plan of a launch file; `sets` override settings, as `--set` does.

    Raises:
        PlanError: the launch file has mistakes.
    """
    return load_plan(file, LaunchOptions(sets=sets))


def settings_in(file: str, component: str) -> dict[str, Any]:
    """Returns the settings that a launch file gives to a component.

    Raises:
        KeyError: the launch file has no such component.
    """
    return dict({each.name: each.config for each in launch_plan(file).components}[component])


def system_of(
    file: str,
    wanted: Callable[[str], bool] | None = None,
    seed: int = 1,
    sets: Sequence[str] = (),
    **changes: dict[str, Any],
) -> MemorySystem:
    """Builds the components of a launch file whose names are `wanted`, in one host, with the settings of the file.

    Args:
        file: launch file.
        wanted: chooses components by name; by default all that start with the run. Channels of the others are silent.
        seed: of the components' random numbers.
        sets: settings to override, as `--set` takes them: `a/camera.errors.delay_s=0.1`.
        changes: further settings by the component's own name: `camera={"flicker": 0.1}`.

    Raises:
        PlanError: the launch file or an overridden setting has mistakes.
    """
    plan = launch_plan(file, tuple(sets))
    found = [each for each in plan.components if (wanted(each.name) if wanted else each.start)]
    return MemorySystem(
        {each.name: _class(each) for each in found},
        {each.name: {**each.config, **changes.get(each.name.rpartition("/")[2], {})} for each in found},
        {each.name: _channels(each) for each in found},
        seed,
        period_s=plan.period_us / 1e6,
        stages=plan.stages,
        outside={name: type_named(kind) for name, kind in plan.outside.items()},
        hosting="single",
        launched=plan,
    )


def _class(component: ComponentPlan) -> Any:
    return getattr(import_module(component.module), component.class_name)


def _channels(component: ComponentPlan) -> dict[str, str]:
    """Returns the channel or the service of each port, or the pattern of a port with many instances."""
    each = {port.attribute for port in declaration(_class(component)).ports if port.each}
    found = {port: [service_of(name) for name in names] for port, names in component.channels.items()}
    return {port: _pattern(names) if port in each else names[0] for port, names in found.items() if names}


def _pattern(names: list[str]) -> str:
    """Returns the shortest pattern of channels in one interface: `cyan*/team_message`."""
    columns = zip(*(name.rpartition("/")[0] for name in names), strict=False)
    prefix = "".join(letters[0] for letters in takewhile(lambda each: len(set(each)) == 1, columns))
    return f"{prefix}*/{names[0].rpartition('/')[2]}"

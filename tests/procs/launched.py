"""Robots as the launch files describe them: settings of single components, and whole teams in memory."""

from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from typing import Any

from fwk.model.plan import ComponentPlan, Plan
from fwk.plan.load import load_plan
from fwk.testing import MemorySystem

RADIO_CHANNELS = {"messages": "{team}*/team_message", "inboxes": "{team}*/team_inbox"}


@lru_cache(maxsize=8)
def plan(file: str) -> Plan:
    """Loads a launch file."""
    return load_plan(file)


def launched_settings(file: str, component: str) -> dict[str, Any]:
    """Returns the settings that a launch file gives to a component."""
    (found,) = [each for each in plan(file).components if each.name == component]
    return dict(found.config)


def launched(file: str, wanted: Callable[[str], bool], seed: int = 1, **changes: dict[str, Any]) -> MemorySystem:
    """Builds the components of a launch file whose names are `wanted`, with its settings, in memory.

    `changes` are further settings by the component's own name: `camera={"every_ticks": 4}`.
    """
    found = [each for each in plan(file).components if wanted(each.name)]
    teams = {each.name.partition("/")[0] for each in found if each.name.endswith("/radio")}
    channels = {
        f"{team}/radio": {port: name.format(team=team.removeprefix("team_")) for port, name in RADIO_CHANNELS.items()}
        for team in teams
    }
    settings = {each.name: {**each.config, **changes.get(each.name.rpartition("/")[2], {})} for each in found}
    return MemorySystem({each.name: _class(each) for each in found}, settings, channels, seed)


def _class(component: ComponentPlan) -> Any:
    return getattr(import_module(component.module), component.class_name)

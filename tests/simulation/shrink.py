"""Shrinks a failing scenario as long as it breaks the same promise."""

import dataclasses
from collections.abc import Callable, Iterator

from tests.simulation.faults import Weather
from tests.simulation.scenario import Scenario

RUNS_MAX = 150
"""Attempts after which the smallest scenario so far is taken."""


def shrink(scenario: Scenario, fails: Callable[[Scenario], bool], runs_max: int = RUNS_MAX) -> Scenario:
    """Returns a smaller scenario for which `fails` is still true."""
    runs, smaller = 0, True
    while smaller and runs < runs_max:
        smaller = False
        for candidate in _smaller(scenario):
            runs += 1
            if fails(candidate):
                scenario, smaller = candidate, True
                break
            if runs >= runs_max:
                break
    return scenario


def _smaller(scenario: Scenario) -> Iterator[Scenario]:
    """Returns smaller candidates, the smallest first."""
    if not scenario.weather.calm:
        yield dataclasses.replace(scenario, weather=Weather())
    if len(scenario.actions) > 1:
        half = len(scenario.actions) // 2
        yield dataclasses.replace(scenario, actions=scenario.actions[half:])
        yield dataclasses.replace(scenario, actions=scenario.actions[:half])
    for place in range(len(scenario.actions)):
        yield dataclasses.replace(scenario, actions=scenario.actions[:place] + scenario.actions[place + 1 :])
    for place, part in enumerate(scenario.parts):
        rest = scenario.parts[:place] + scenario.parts[place + 1 :]
        partners = {"Boss": "Worker", "Worker": "Boss"}
        lonely = part.kind in partners and not any(each.kind == part.kind for each in rest)
        if lonely and any(each.kind == partners[part.kind] for each in rest):
            rest = tuple(each for each in rest if each.kind != partners[part.kind])
        if rest:
            names = {each.name for each in rest} | {"supervisor", "gateway"}
            actions = tuple(action for action in scenario.actions if action.target in names)
            yield dataclasses.replace(scenario, parts=rest, actions=actions)
    for ticks in sorted({scenario.ticks // 2, scenario.ticks - 1} - {0, scenario.ticks}):
        yield dataclasses.replace(scenario, ticks=ticks)
    for name, usual in dataclasses.asdict(Weather()).items():
        if getattr(scenario.weather, name) != usual:
            weather = dataclasses.replace(scenario.weather, **{name: usual})
            yield dataclasses.replace(scenario, weather=weather)
    if scenario.hosting != "process":
        yield dataclasses.replace(scenario, hosting="process")
    for place, part in enumerate(scenario.parts):
        for setting in part.settings:
            settings = {name: value for name, value in part.settings.items() if name != setting}
            plainer = dataclasses.replace(part, settings=settings)
            yield dataclasses.replace(scenario, parts=(*scenario.parts[:place], plainer, *scenario.parts[place + 1 :]))
        if part.turns != (1, 0):
            plainer = dataclasses.replace(part, turns=(1, 0))
            yield dataclasses.replace(scenario, parts=(*scenario.parts[:place], plainer, *scenario.parts[place + 1 :]))
        if len(part.stages) > 1:
            plainer = dataclasses.replace(part, stages=part.stages[:1])
            yield dataclasses.replace(scenario, parts=(*scenario.parts[:place], plainer, *scenario.parts[place + 1 :]))
    for place, action in enumerate(scenario.actions):
        for field in ("after_tick", "delay_us", "amount"):
            value = getattr(action, field)
            if value > 1:
                plainer_action = dataclasses.replace(action, **{field: value // 2})
                actions = (*scenario.actions[:place], plainer_action, *scenario.actions[place + 1 :])
                yield dataclasses.replace(scenario, actions=actions)

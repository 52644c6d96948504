"""Run of a scenario in memory: its components, its mistakes and its verdict."""

import os
import stat
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any, get_type_hints

import yaml

from fwk import Alike, Component, Config
from fwk.testing import Document, Expression, ExpressionError, MemorySystem, Verdict, play
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.drivers.base import Base
from procs.drivers.kicker import Kicker
from procs.localization.localization import Localization
from procs.model.right_name import right_name
from procs.model.robot import number_of, team_of
from procs.referee.referee import Referee
from procs.scenarios.crew import Crew
from procs.scenarios.dummy import Dummy
from procs.scenarios.file import LONGEST, Scenario, ScenarioError, parsed
from procs.scenarios.perfect_world import PerfectWorldModel
from procs.scenarios.scripted import Script
from procs.scenarios.words import WORDS
from procs.simulation.percepts import Percepts
from procs.simulation.radio import Radio
from procs.simulation.simulator import Simulator
from procs.world_model.world_model import WorldModel

CREW = "world/crew"
"""Component that carries out the commands of a scenario."""
_ROBOT: dict[str, type[Component]] = {
    "base": Base,
    "kicker": Kicker,
    "world_model": PerfectWorldModel,
    "agent": Agent,
    "skiller": Skiller,
    "navigator": Navigator,
}
_SEEING: dict[str, type[Component]] = {
    **_ROBOT,
    "percepts": Percepts,
    "localization": Localization,
    "world_model": WorldModel,
}
_SCRIPTED: dict[str, type[Component]] = {"base": Base, "kicker": Kicker, "script": Script}
_LETTERS = 10 * LONGEST
"""Most letters of a file that are read, so that the error names the length of a file that is only somewhat too long."""
_RADIO = {"messages": "{team}*/team_message", "inboxes": "{team}*/team_inbox"}


def read(path: Path) -> Scenario:
    """Reads a scenario.

    Raises:
        ScenarioError: the file is not a scenario; the text has a line for each mistake.
        OSError: the file cannot be read.
    """
    try:
        with open(path, encoding="utf-8", opener=_at_once) as file:
            os.set_blocking(file.fileno(), True)
            text = file.read(_LETTERS + 1)  # a device such as /dev/zero has no end
            unwritten = not text and stat.S_ISFIFO(os.fstat(file.fileno()).st_mode)
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{path}: it is not UTF-8 text") from error
    if len(text) > _LETTERS:
        raise ScenarioError(f"{path}: it has more than {_LETTERS:,} letters; a scenario has {LONGEST:,} at most")
    if unwritten:
        raise ScenarioError(f"{path}: it is a pipe into which no program writes; name a file")
    return parsed(text, str(path), _check, _check_run)


def _at_once(path: str, flags: int) -> int:
    """Opens a file without waiting for the writer of a pipe."""
    return os.open(path, flags | os.O_NONBLOCK)


def _check(scenario: Scenario, document: Document) -> None:
    """Adds the mistakes in settings."""
    kinds = _components(scenario)
    for name, values in scenario.settings.items():
        config = _config(kinds[name]) if name in kinds else None
        if name not in kinds:
            shared = "write realism: beside settings:, and field, robot, ball and players under rules:"
            right = shared if name == "shared" else right_name(name, kinds)
            document.add(f"settings: no component '{name}'; {right}", "settings", name)
        elif name == CREW:
            document.add(f"settings: {CREW} has its actions under commands", "settings", name)
        elif config:
            document.values(config, "settings", name, who=name, what="setting")
        elif values:
            document.add(f"settings: {name} has no settings", "settings", name)
    for name, setting, where in _stated(scenario):
        if setting in scenario.settings.get(name, {}):
            text = f"settings: '{setting}' of {name} is stated under {where}, too; keep one"
            document.add(text, "settings", name, setting)
    for name, setting in _unlike(scenario):
        text = f"settings: '{setting}' of {name} is not that of all components; state it under rules:, for all"
        document.add(text, "settings", name, setting)


def _unlike(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yields settings that components should have alike but do not, each after the first component that states it."""
    owners: dict[str, list[str]] = {}
    for name, kind in _components(scenario).items():
        for setting, field in getattr(_config(kind), "model_fields", {}).items():
            if Alike in field.metadata:
                owners.setdefault(setting, []).append(name)
    for setting, names in owners.items():
        stated = {name: scenario.settings.get(name, {}).get(setting) for name in names}
        own = [name for name, value in stated.items() if value is not None]
        if own and any(value != stated[own[0]] for value in stated.values()):
            yield own[0], setting


def _stated(scenario: Scenario) -> Iterator[tuple[str, str, str]]:
    """Yields the settings that other keys of the file state: component, setting, and the key."""
    yield from (("world/referee", rule, "rules") for rule in scenario.rules)
    yield from (("world/simulator", rule, "rules") for rule in scenario.shared)
    yield from ((f"{robot}/script", "steps", "scripted") for robot in scenario.scripted)
    for setting, key in (("starts", "places"), ("realism", "realism")):
        if key in scenario.model_fields_set:
            yield "world/simulator", setting, key


def _check_run(scenario: Scenario, document: Document) -> None:
    """Adds the conditions that name a channel, field, robot or state that the first tick does not have.

    Settings with which no system begins, such as two robots of one number, come before.
    """
    try:
        system = system_of(scenario)
        system.tick()
    except ValueError as error:
        document.add(str(error), "settings", str(error).partition(":")[0])
        return
    for path, text in scenario.conditions:
        try:
            Expression(text, WORDS).holds(system.newest)
        except ExpressionError as error:
            cause = error.__cause__
            if cause is None or isinstance(cause, (AttributeError, KeyError, OverflowError, RecursionError, TypeError)):
                document.add(str(error), *path)


def _config(kind: type[Component]) -> type[Config] | None:
    config = get_type_hints(kind).get("config")
    return config if isinstance(config, type) and issubclass(config, Config) else None


def _components(scenario: Scenario) -> dict[str, type[Component]]:
    components: dict[str, type[Component]] = {"world/simulator": Simulator, "world/referee": Referee, CREW: Crew}
    components |= {f"{robot}/{name}": part for robot in scenario.robots for name, part in _ROBOT.items()}
    components |= {f"{robot}/{name}": part for robot in scenario.seeing for name, part in _SEEING.items()}
    components |= {f"{robot}/{name}": part for robot in scenario.scripted for name, part in _SCRIPTED.items()}
    components |= {f"team_{team}/radio": Radio for team in sorted(set(map(team_of, scenario.seeing)))}
    return components | {f"{robot}/dummy": Dummy for robot in scenario.dummies}


def system_of(scenario: Scenario) -> MemorySystem:
    """Builds the system of a scenario in memory."""
    settings, channels, turns = _settings(scenario)
    return MemorySystem(_components(scenario), settings, channels, scenario.seed, turns=turns)


def launch_file_of(scenario: Scenario, name: str) -> str:
    """Returns a launch file with which `fwk-launch` plays a scenario in real processes, with the same messages."""
    settings, channels, turns = _settings(scenario)
    components: dict[str, dict[str, Any]] = {}
    for component, kind in _components(scenario).items():
        part = components[component] = {"use": f"{kind.__module__}:{kind.__name__}"}
        if component in turns:
            part["every"], part["offset"] = turns[component]
        part |= {"config": settings[component]} if settings.get(component) else {}
        part |= {"channels": channels[component]} if component in channels else {}
    text = {"name": name, "seed": scenario.seed, **_VIEWS, "components": components}
    heading = f"# fwk-launch FILE --time {scenario.time_s:g} plays the scenario {name}.\n"
    return heading + yaml.safe_dump(text, sort_keys=False)


_VIEWS = {"scoreboard": "procs.view.scoreboard:headline", "video": "procs.view.top_view:picture_with_beliefs"}
Settings = dict[str, dict[str, Any]]


def _settings(scenario: Scenario) -> tuple[Settings, dict[str, dict[str, str]], dict[str, tuple[int, int]]]:
    """Returns settings, channels, and `every` with `offset`, by component, where they are not the usual ones."""
    rules = dict(scenario.rules)
    if scenario.ball:  # play begins at once: the kick-off is free, and the ball is put elsewhere
        rules = {"kick_off_stoppage_s": 0.0, "positions_s": 0.0} | rules
    settings: Settings = {
        "world/simulator": {"starts": scenario.places},
        "world/referee": rules,
        CREW: {"actions": [action.model_dump(exclude_none=True) for action in scenario.actions]},
    }
    for robot, steps in scenario.scripted.items():
        settings[f"{robot}/script"] = {"steps": [step.model_dump(exclude_defaults=True) for step in steps]}
    channels, turns = {}, {}
    for name, part in _components(scenario).items():
        config = _config(part)
        shared = deepcopy(scenario.shared)  # each its own, so that a launch file writes them out
        for setting, value in {"realism": scenario.realism, **shared}.items():
            if config and setting in config.model_fields:
                settings[name] = settings.get(name, {}) | {setting: value}
        if part is Percepts:
            turns[name] = (2, number_of(name.partition("/")[0]))  # robots take turns, as in the launch files
        if part is Radio:
            team = name.removeprefix("team_").removesuffix("/radio")
            channels[name] = {port: channel.format(team=team) for port, channel in _RADIO.items()}
    for component, more in scenario.settings.items():
        settings[component] = settings.get(component, {}) | more
    return settings, channels, turns


def run(path: Path) -> Verdict:
    """Plays the scenario of a file. What its crew could not do counts as broken.

    Raises:
        ScenarioError: the file is not a scenario.
        ExpressionError: a condition cannot be understood.
    """
    return outcome(read(path))


def outcome(scenario: Scenario) -> Verdict:
    """Plays a scenario.

    Raises:
        ExpressionError: a condition cannot be understood.
    """
    system = system_of(scenario)
    verdict = play(system, scenario, WORDS, scenario.begins_s)
    crew = system.runners[CREW].component
    assert isinstance(crew, Crew)
    while verdict.ok and crew.unanswered and verdict.time_s < scenario.time_s - 1e-9:  # it ended before its commands
        system.tick()
        verdict.time_s = system.now_us / 1e6
    verdict.broken += crew.refused
    if verdict.ok:
        verdict.broken += crew.unanswered
    return verdict

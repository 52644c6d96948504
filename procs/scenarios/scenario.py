"""A soccer scenario: robots, start, actions of the field crew, and what must happen."""

from pathlib import Path
from typing import Annotated, Any, get_type_hints

import yaml
from pydantic import FiniteFloat, NonNegativeInt, Strict, ValidationError

from fwk import Component, Config
from fwk.testing import Expectations, Expression, ExpressionError, MemorySystem, Verdict, play
from lcmtypes.soccer import place_ball_t
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.drivers.base import Base
from procs.drivers.kicker import Kicker
from procs.localization.localization import Localization
from procs.model.realism import Realism
from procs.model.robot import team_of
from procs.referee.referee import Referee, RefereeConfig
from procs.scenarios.crew import Action, Crew
from procs.scenarios.dummy import Dummy
from procs.scenarios.mistakes import (
    UniqueKeys,
    command_mistakes,
    field_mistakes,
    place_mistakes,
    robot_mistakes,
    settings_mistakes,
    team_mistakes,
    texts_of,
)
from procs.scenarios.perfect_world import PerfectWorldModel
from procs.scenarios.words import WORDS
from procs.simulation.percepts import Percepts
from procs.simulation.radio import Radio
from procs.simulation.simulator import Simulator, SimulatorConfig
from procs.world_model.world_model import WorldModel

BOOK = Path(__file__).parent / "book"
"""Folder of the scenarios that come with the robots."""
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
_RADIO = {"messages": "{team}*/team_message", "inboxes": "{team}*/team_inbox"}
_Number = Annotated[FiniteFloat, Strict()]


class ScenarioError(ValueError):
    """A file that is not a scenario."""


class Scenario(Expectations):
    """A scenario as its file states it. Its `robots` know the world up to the noise of their settings."""

    robots: list[str] = []
    """Robots with all their components but perception."""
    seeing: list[str] = []
    """Robots with all their components; their percepts are drawn from the truth, with errors."""
    dummies: list[str] = []
    """Robots that stand still."""
    places: dict[str, tuple[_Number, _Number, _Number]] = {}
    """Start of robots: x in m, y in m, heading in rad (world frame); others take their default place."""
    ball: dict[str, _Number] = {}
    """Place and velocity of the ball once play has begun, as in `place_ball_t`; empty: the kick-off."""
    rules: dict[str, Any] = {}
    """Settings of the referee."""
    realism: Realism = "realistic"
    """Preset of the simulator."""
    settings: dict[str, dict[str, Any]] = {}
    """Further settings, by component: `cyan2/agent`."""
    commands: list[Action] = []
    """Actions of the field crew."""
    seed: Annotated[NonNegativeInt, Strict()] = 1
    """Seed of the run."""


def read(path: Path) -> Scenario:
    """Reads a scenario.

    Raises:
        ScenarioError: the file is not a scenario; the text has a line for each mistake.
        OSError: the file cannot be read.
    """
    try:
        content = yaml.load(path.read_text(), UniqueKeys)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise ScenarioError(f"{path}:{mark.line + 1 if mark else 1}: {error.problem or error.context}") from error
    except RecursionError as error:
        raise ScenarioError(f"{path}: its values are nested too deep") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: {error}") from error
    if not isinstance(content, dict):
        raise ScenarioError(f"{path}: holds no keys; there are {', '.join(Scenario.model_fields)}")
    try:
        scenario = Scenario.model_validate(content)
    except ValidationError as error:
        found = texts_of(error, known=list(Scenario.model_fields))
    else:
        found = _mistakes(scenario)
    if found:
        raise ScenarioError("\n".join(f"{path}: {each}" for each in found))
    return scenario


def _mistakes(scenario: Scenario) -> list[str]:
    robots = scenario.robots + scenario.seeing
    found = list(robot_mistakes(robots, scenario.dummies, scenario.places))
    found += team_mistakes(robots, scenario.settings)
    found += [f"ball: {each}" for each in field_mistakes(scenario.ball, place_ball_t())]
    configs = {name: _config(kind) for name, kind in _components(scenario).items()}
    try:
        RefereeConfig.model_validate(scenario.rules)
    except ValidationError as error:
        found += texts_of(error, "rules", list(RefereeConfig.model_fields))
    found += settings_mistakes(scenario.settings, configs)
    if CREW in scenario.settings:
        found.append(f"settings: {CREW} has its actions under commands")
    for text in (*scenario.eventually, *scenario.in_order, *scenario.always, *scenario.at_end):
        try:
            Expression(text, WORDS)
        except ExpressionError as error:
            found.append(str(error))
    found += command_mistakes(scenario.commands, [*robots, *scenario.dummies], scenario.time_s)
    if not found:
        found += place_mistakes(scenario.places, _simulator_settings(scenario))
    if not found:
        found += _unknown_in(scenario)
    if not (scenario.eventually or scenario.in_order or scenario.always or scenario.at_end):
        found.append("nothing has to happen; give eventually, in_order, always or at_end")
    return found


def _unknown_in(scenario: Scenario) -> list[str]:
    """Returns the conditions that name a channel, field, robot or state that the first tick does not have.

    Settings with which no system begins, such as two robots of one number, come before.
    """
    found: list[str] = []
    try:
        system = system_of(scenario)
        system.tick()
    except ValueError as error:
        return [str(error)]
    for text in (*scenario.eventually, *scenario.in_order, *scenario.always, *scenario.at_end):
        try:
            Expression(text, WORDS).holds(system.newest)
        except ExpressionError as error:
            cause = error.__cause__
            if cause is None or isinstance(cause, (AttributeError, KeyError, OverflowError, RecursionError, TypeError)):
                found.append(str(error))
    return found


def _simulator_settings(scenario: Scenario) -> SimulatorConfig:
    """Returns the settings of the simulator, without the places of the scenario."""
    return SimulatorConfig.model_validate({"realism": scenario.realism} | scenario.settings.get("world/simulator", {}))


def _config(kind: type[Component]) -> type[Config] | None:
    config = get_type_hints(kind).get("config")
    return config if isinstance(config, type) and issubclass(config, Config) else None


def _components(scenario: Scenario) -> dict[str, type[Component]]:
    components: dict[str, type[Component]] = {"world/simulator": Simulator, "world/referee": Referee, CREW: Crew}
    components |= {f"{robot}/{name}": part for robot in scenario.robots for name, part in _ROBOT.items()}
    components |= {f"{robot}/{name}": part for robot in scenario.seeing for name, part in _SEEING.items()}
    components |= {f"team_{team}/radio": Radio for team in sorted(set(map(team_of, scenario.seeing)))}
    return components | {f"{robot}/dummy": Dummy for robot in scenario.dummies}


def system_of(scenario: Scenario) -> MemorySystem:
    """Builds the system of a scenario in memory."""
    rules, actions = dict(scenario.rules), list(scenario.commands)
    if scenario.ball:  # play begins at once: the kick-off is free, and the ball is put elsewhere
        rules = {"kick_off_stoppage_s": 0.0, "positions_s": 0.0} | rules
        actions.append(Action(at_s=0.1, place_ball=scenario.ball))
    settings: dict[str, dict[str, Any]] = {
        "world/simulator": {"starts": scenario.places, "realism": scenario.realism},
        "world/referee": rules,
        CREW: {"actions": [action.model_dump(exclude_none=True) for action in actions]},
    }
    components = _components(scenario)
    channels, turns = {}, {}
    for name, part in components.items():
        if part is Percepts:
            settings[name], turns[name] = {"realism": scenario.realism}, (2, 0)
        if part is Radio:
            team = name.removeprefix("team_").removesuffix("/radio")
            settings[name] = {"realism": scenario.realism}
            channels[name] = {port: channel.format(team=team) for port, channel in _RADIO.items()}
    for component, more in scenario.settings.items():
        settings[component] = settings.get(component, {}) | more
    return MemorySystem(components, settings, channels, scenario.seed, turns=turns)


def run(path: Path) -> Verdict:
    """Plays the scenario of a file. What its crew could not do counts as broken.

    Raises:
        ScenarioError: the file is not a scenario.
        ExpressionError: a condition cannot be understood.
    """
    scenario = read(path)
    try:
        return outcome(scenario)
    except ExpressionError as error:
        raise ExpressionError(f"{path}: {error}") from error


def outcome(scenario: Scenario) -> Verdict:
    """Plays a scenario.

    Raises:
        ExpressionError: a condition cannot be understood.
    """
    system = system_of(scenario)
    verdict = play(system, scenario, WORDS)
    crew = system.runners[CREW].component
    assert isinstance(crew, Crew)
    while verdict.ok and crew.unanswered and verdict.time_s < scenario.time_s - 1e-9:  # it ended before its commands
        system.tick()
        verdict.time_s = system.now_us / 1e6
    verdict.broken += crew.refused
    if verdict.ok:
        verdict.broken += crew.unanswered
    return verdict

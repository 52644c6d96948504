"""A soccer scenario: robots, start, deeds of the field crew, and what must happen."""

from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from fwk import Component
from fwk.testing import Expectations, MemorySystem, Verdict, play
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.drivers.base import Base
from procs.drivers.kicker import Kicker
from procs.referee.referee import Referee
from procs.scenarios.crew import Action, Crew
from procs.scenarios.dummy import Dummy
from procs.scenarios.perfect_world import PerfectWorldModel
from procs.scenarios.words import WORDS
from procs.simulation.simulator import Simulator

BOOK = Path(__file__).parent / "book"
"""Folder of the scenarios that come with the robots."""
_ROBOT: dict[str, type[Component]] = {
    "base": Base,
    "kicker": Kicker,
    "world_model": PerfectWorldModel,
    "agent": Agent,
    "skiller": Skiller,
    "navigator": Navigator,
}


class ScenarioError(ValueError):
    """A file that is not a scenario."""


class Scenario(Expectations):
    """A scenario as its file states it. Robots know the world up to the noise of their settings."""

    robots: list[str] = []
    """Robots with all their components but perception."""
    dummies: list[str] = []
    """Robots that stand still."""
    places: dict[str, tuple[float, float, float]] = {}
    """Start of robots: x in m, y in m, heading in rad (world frame); others take their default place."""
    ball: dict[str, float] = {}
    """Place and velocity of the ball once play has begun, as in `place_ball_t`; empty: the kick-off."""
    rules: dict[str, Any] = {}
    """Settings of the referee."""
    realism: str = "realistic"
    """Preset of the simulator."""
    settings: dict[str, dict[str, Any]] = {}
    """Further settings, by component: `cyan2/agent`."""
    commands: list[Action] = []
    """Deeds of the field crew."""
    seed: int = 1
    """Seed of the run."""


def read(path: Path) -> Scenario:
    """Reads a scenario.

    Raises:
        ScenarioError: the file is not a scenario.
        OSError: the file cannot be read.
    """
    try:
        return Scenario.model_validate(yaml.safe_load(path.read_text()))
    except (yaml.YAMLError, ValidationError) as error:
        raise ScenarioError(f"{path}: {error}") from error


def system_of(scenario: Scenario) -> MemorySystem:
    """Builds the system of a scenario in memory."""
    components: dict[str, type[Component]] = {"world/simulator": Simulator, "world/referee": Referee}
    components["world/crew"] = Crew
    components |= {f"{robot}/{name}": part for robot in scenario.robots for name, part in _ROBOT.items()}
    components |= {f"{robot}/dummy": Dummy for robot in scenario.dummies}
    rules, actions = dict(scenario.rules), list(scenario.commands)
    if scenario.ball:  # play begins at once: the kick-off is free, and the ball is put elsewhere
        rules = {"kick_off_stoppage_s": 0.0, "positions_s": 0.0} | rules
        actions.append(Action(at_s=0.1, place_ball=scenario.ball))
    settings: dict[str, dict[str, Any]] = {
        "world/simulator": {"starts": scenario.places, "realism": scenario.realism},
        "world/referee": rules,
        "world/crew": {"actions": [action.model_dump(exclude_none=True) for action in actions]},
        **scenario.settings,
    }
    return MemorySystem(components, settings=settings, seed=scenario.seed)


def run(path: Path) -> Verdict:
    """Plays the scenario of a file.

    Raises:
        ScenarioError: the file is not a scenario.
        ExpressionError: a condition cannot be understood.
    """
    scenario = read(path)
    return play(system_of(scenario), scenario, WORDS)

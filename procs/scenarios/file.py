"""Scenario file: its keys and their meanings, and the book of scenarios."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import BeforeValidator, FiniteFloat, NonNegativeInt, Strict, ValidationError

from fwk.testing import Expectations
from procs.model.realism import Realism
from procs.scenarios.action import Action
from procs.scenarios.mistakes import (
    UniqueKeys,
    ball_mistakes,
    command_mistakes,
    place_mistakes,
    robot_mistakes,
    simulator_settings,
    team_mistakes,
    texts_of,
)
from procs.simulation.physics.start_places import three_numbers
from procs.simulation.simulator import SimulatorConfig

BOOK = Path(__file__).parent / "book"
"""Folder of the scenarios that come with the robots."""
_BALL_S = 0.1
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
    places: dict[str, Annotated[tuple[_Number, _Number, _Number], BeforeValidator(three_numbers)]] = {}
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

    @property
    def everyone(self) -> list[str]:
        """Names of all robots."""
        return [*self.robots, *self.seeing, *self.dummies]

    @property
    def conditions(self) -> list[str]:
        """All conditions."""
        return [*self.eventually, *self.in_order, *self.always, *self.at_end]

    @property
    def actions(self) -> list[Action]:
        """Actions of the field crew, among them that which puts the ball to its place once the kick-off has begun."""
        return self.commands + ([Action(at_s=_BALL_S, place_ball=self.ball)] if self.ball else [])


def parsed(text: str, where: str, further: Callable[[Scenario], Iterable[str]] = lambda _: ()) -> Scenario:
    """Returns the scenario of a file's text.

    Args:
        text: content of the file.
        where: name of the file, for the mistakes.
        further: returns mistakes beside those of robots, places and commands.

    Raises:
        ScenarioError: the text is not a scenario; the error has a line for each mistake.
    """
    try:
        content = yaml.load(text, UniqueKeys)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise ScenarioError(f"{where}:{mark.line + 1 if mark else 1}: {error.problem or error.context}") from error
    except RecursionError as error:
        raise ScenarioError(f"{where}: its values are nested too deep") from error
    except yaml.YAMLError as error:
        raise ScenarioError(f"{where}: {error}") from error
    if not isinstance(content, dict):
        raise ScenarioError(f"{where}: holds no keys; there are {', '.join(Scenario.model_fields)}")
    try:
        scenario = Scenario.model_validate(content)
    except ValidationError as error:
        found = texts_of(error, known=list(Scenario.model_fields))
    else:
        config = simulator_settings(scenario.settings)
        found = [*_mistakes(scenario, config), *further(scenario)]
        if not scenario.conditions:
            found.append("nothing has to happen; give eventually, in_order, always or at_end")
        found = found or list(place_mistakes(scenario.places, config))
    if found:
        raise ScenarioError("\n".join(f"{where}: {each}" for each in found))
    return scenario


def _mistakes(scenario: Scenario, config: SimulatorConfig) -> list[str]:
    found = list(robot_mistakes([*scenario.robots, *scenario.seeing], scenario.dummies, scenario.places))
    found += team_mistakes([*scenario.robots, *scenario.seeing], scenario.settings)
    found += ball_mistakes(scenario.ball, config.field)
    found += command_mistakes(scenario.commands, scenario.everyone, scenario.time_s, config)
    return found

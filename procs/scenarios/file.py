"""Scenario file: its keys and their meanings, and the book of scenarios."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, FiniteFloat, NonNegativeInt, Strict

from fwk.testing import Document, Expectations, Expression, ExpressionError, PlanError
from procs.model.realism import Realism
from procs.referee.referee import RefereeConfig
from procs.scenarios.action import Action
from procs.scenarios.mistakes import (
    ball_mistakes,
    command_mistakes,
    place_mistakes,
    robot_mistakes,
    script_mistakes,
    simulator_settings,
    team_mistakes,
)
from procs.scenarios.scripted import Step
from procs.scenarios.words import WORDS
from procs.simulation.physics.start_places import three_numbers
from procs.simulation.simulator import SimulatorConfig

BOOK = Path(__file__).parent / "book"
"""Folder of the scenarios that come with the robots."""
_BALL_S, _LAID_S = 0.1, 0.15
"""Time at which the ball is put to its place, and that of the next tick, which shows it there."""
SHARED = ("field", "robot", "ball", "players")
"""Rules that every component with a setting of the name gets, as from the section `shared` of a launch file."""
LONGEST = 100_000
"""Letters of a file at most: a match waits while its crew reads one."""
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
    scripted: dict[str, list[Step]] = {}
    """Robots that drive and kick by a script, and the steps of each."""
    places: dict[str, Annotated[tuple[_Number, _Number, _Number], BeforeValidator(three_numbers)]] = {}
    """Start of robots: x in m, y in m, heading in rad (world frame); others take their default place."""
    ball: dict[str, _Number] = {}
    """Place and velocity of the ball once play has begun, as in `place_ball_t`; empty: the kick-off."""
    rules: dict[str, Any] = {}
    """Settings of the referee; those in `SHARED` reach all components that have them."""
    realism: Realism = "realistic"
    """Preset of bodies, ball, percepts and radio, and of the errors that the robots state."""
    settings: dict[str, dict[str, Any]] = {}
    """Further settings, by component: `cyan2/agent`."""
    commands: list[Action] = []
    """Actions of the field crew."""
    seed: Annotated[NonNegativeInt, Strict()] = 1
    """Seed of the run."""

    @property
    def everyone(self) -> list[str]:
        """Names of all robots."""
        return [*self.robots, *self.seeing, *self.dummies, *self.scripted]

    @property
    def shared(self) -> dict[str, Any]:
        """Settings that all components share."""
        return {name: self.rules[name] for name in SHARED if name in self.rules}

    @property
    def begins_s(self) -> float:
        """Logical time from which the conditions count: the ball lies at its place."""
        return _LAID_S if self.ball else 0.0

    @property
    def actions(self) -> list[Action]:
        """Actions of the field crew, among them that which puts the ball to its place once the kick-off has begun."""
        return self.commands + ([Action(at_s=_BALL_S, place_ball=self.ball)] if self.ball else [])


Check = Callable[[Scenario, Document], None]
"""Adds the mistakes of a scenario to its document."""


def _nothing(_: Scenario, __: Document) -> None:
    pass


def parsed(text: str, where: str, further: Check = _nothing, last: Check = _nothing) -> Scenario:
    """Returns the scenario of a file's text.

    Args:
        text: content of the file.
        where: name of the file, for the mistakes.
        further: checks more than robots, places, rules, commands and conditions.
        last: checks what only a scenario without other mistakes shows.

    Raises:
        ScenarioError: the text is not a scenario; the error has a line for each mistake.
    """
    if len(text) > LONGEST:
        raise ScenarioError(f"{where}: it has {len(text):,} letters; a scenario has {LONGEST:,} at most")
    try:
        document = Document(text, where)
        scenario = document.values(Scenario)
        document.raise_mistakes()
        assert scenario
        scenario.written_in(document)
        config = simulator_settings(scenario.shared | scenario.settings.get("world/simulator", {}))
        _add(document, _mistakes(scenario, config))
        document.values(RefereeConfig, "rules", who="rules", what="setting")
        _add_conditions(document, scenario)
        further(scenario, document)
        document.raise_mistakes()
        _add(document, place_mistakes(scenario.places, config))
        document.raise_mistakes()
        last(scenario, document)
        document.raise_mistakes()
    except PlanError as error:
        raise ScenarioError(str(error)) from error
    return scenario


def _mistakes(scenario: Scenario, config: SimulatorConfig) -> Iterator[str]:
    thinking = {"robots": scenario.robots, "seeing": scenario.seeing}
    yield from robot_mistakes({**thinking, "dummies": scenario.dummies, "scripted": scenario.scripted}, scenario.places)
    yield from team_mistakes(thinking, [scenario.rules, *scenario.settings.values()])
    yield from script_mistakes(scenario.scripted, scenario.time_s)
    yield from ball_mistakes(scenario.ball, config.field)
    yield from command_mistakes(scenario.commands, scenario.everyone, scenario.time_s, config)
    if scenario.ball and scenario.time_s < _LAID_S:
        yield f"ball: it lies at its place from {_LAID_S:g} s on; the scenario ends at {scenario.time_s:g} s"
    if not scenario.conditions:
        yield "nothing has to happen; give eventually, in_order, always or at_end"


def _add(document: Document, mistakes: Iterable[str]) -> None:
    """Adds mistakes, each with the line of the value with whose path it begins."""
    for mistake in mistakes:
        path = mistake.partition(":")[0].split(".")
        document.add(mistake, *(int(key) if key.isdecimal() else key for key in path))


def _add_conditions(document: Document, scenario: Scenario) -> None:
    """Adds the conditions that cannot be understood."""
    for path, text in scenario.conditions:
        try:
            Expression(text, WORDS)
        except ExpressionError as error:
            document.add(str(error), *path)

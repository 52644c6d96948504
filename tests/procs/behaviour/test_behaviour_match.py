"""Matches with a perfect world model: kick-off, goals, defence, and the same match twice."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pytest

from fwk import Component
from fwk.testing import MemorySystem
from lcmtypes.soccer import game_state_t, ground_truth_t, match_event_t
from procs.behaviour.agent import Agent
from procs.behaviour.navigator import Navigator
from procs.behaviour.skiller import Skiller
from procs.drivers.base import Base
from procs.drivers.kicker import Kicker
from procs.referee.referee import Referee
from procs.scenarios.action import Action
from procs.scenarios.file import Scenario
from procs.scenarios.perfect_world import PerfectWorldModel
from procs.scenarios.scenario import system_of
from procs.simulation.simulator import Simulator

PARTS: dict[str, type[Component]] = {
    "base": Base,
    "kicker": Kicker,
    "world_model": PerfectWorldModel,
    "agent": Agent,
    "skiller": Skiller,
    "navigator": Navigator,
}
STOPPED_S = 6.0
"""The game is stopped before the kick-off for at least so long."""
PLAY_MAX_S = 25
"""Three robots have kicked by then."""
CHANCE_S = 10
"""A chance before the goal has led to a goal by then."""
CHANCES = 3
"""Matches in which a team gets a chance; one of them brings a goal."""
DUELS = 4
"""Matches of two robots; the one with the kick-off scores in one of their first minutes."""
NOISE = {"place_sd_m": 0.03, "heading_sd_rad": 0.015, "ball_sd_m": 0.05, "ball_velocity_sd_m_s": 0.2}


def match(robots: Sequence[str], seed: int, noise: dict[str, float], **simulator: Any) -> MemorySystem:
    components: dict[str, type[Component]] = {"world/simulator": Simulator, "world/referee": Referee}
    components.update({f"{robot}/{name}": part for robot in robots for name, part in PARTS.items()})
    settings: dict[str, dict[str, Any]] = {f"{robot}/world_model": dict(noise) for robot in robots}
    return MemorySystem(components, settings={**settings, "world/simulator": simulator}, seed=seed)


def team(colour: str, number: int) -> list[str]:
    return [f"{colour}{index + 1}" for index in range(number)]


def play(system: MemorySystem, duration_s: float) -> tuple[list[game_state_t], list[match_event_t]]:
    states, events = [], []
    for _ in range(round(duration_s * 20)):
        system.tick()
        states.append(system.newest("world/game_state"))
        events += system.newest("world/match_events").events
    return states, events


@dataclass(frozen=True)
class Played:
    """A match of ten robots: its course, and the positions after the first 6 s."""

    system: MemorySystem
    truth: ground_truth_t
    states: list[game_state_t]
    events: list[match_event_t]

    @property
    def kickers(self) -> set[str]:
        return {event.robot for event in self.events if event.kind == match_event_t.KICK}


@pytest.fixture(scope="module")
def ten() -> Played:
    """A match of ten robots, until three of them have kicked."""
    system = match(team("cyan", 5) + team("magenta", 5), 7, NOISE)
    before, events = play(system, STOPPED_S)
    truth = system.newest("world/ground_truth")
    played = Played(system, truth, before, events)
    for _ in range(PLAY_MAX_S):
        states, more = play(system, 1.0)
        played.states.extend(states)
        played.events.extend(more)
        if len(played.kickers) >= 3:
            break
    return played


@pytest.mark.slow
def test_lone_robot_scores_on_an_empty_goal_after_kick_off() -> None:
    for seed in (1, 2, 3):
        states, _ = play(match(["cyan2"], seed, NOISE), 16.0)
        assert states[-1].score_cyan == 1, f"seed {seed}"


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["cyan", "magenta"])
def test_two_alone_score_after_their_kick_off(colour: str) -> None:
    robots = ["cyan1", "magenta1"]
    kick_off = Action(at_s=0.1, referee={"name": "kickoff", "team": colour})
    settings = {f"{robot}/world_model": dict(NOISE) for robot in robots}
    for seed in range(1, DUELS + 1):
        system = system_of(Scenario(robots=robots, commands=[kick_off], seed=seed, settings=settings))
        for _ in range(60):
            states, _ = play(system, 1.0)
            if getattr(states[-1], f"score_{colour}"):
                return
    pytest.fail(f"{colour} scored in none of {DUELS} matches of a minute")


@pytest.mark.slow
def test_ten_robots_play_by_the_rules(ten: Played) -> None:
    end = round(STOPPED_S * 20)
    assert ten.states[end - 1].stopped
    for robot in ten.truth.robots:
        own_side = -1 if robot.name.startswith("cyan") else 1
        assert robot.x_m * own_side > 0, f"{robot.name} is in the other half"
        assert robot.name.startswith("cyan") or math.hypot(robot.x_m, robot.y_m) > 3.0
    assert any(state.state == game_state_t.PLAY for state in ten.states[end : end + 200])


@pytest.mark.slow
def test_ten_robots_shoot_and_pass(ten: Played) -> None:
    assert len(ten.kickers) >= 3


def chance(colour: str, seed: int) -> MemorySystem:
    """Returns a match of ten in which the ball lies before an attacker, with the goalkeeper between it and the goal."""
    side, other = (1.0, "magenta") if colour == "cyan" else (-1.0, "cyan")
    own = [(-10.4, 0.0), (5.7, 1.0), (4.0, -3.0), (-2.0, 2.0), (-4.0, -2.0)]
    theirs = [(10.4, 0.0), (1.0, 3.0), (1.5, -1.0), (0.0, 4.0), (-1.0, -4.0)]
    places = {
        name: (side * x_m, side * y_m, 0.0 if (side > 0) == (name.startswith(colour)) else math.pi)
        for names, middles in ((team(colour, 5), own), (team(other, 5), theirs))
        for name, (x_m, y_m) in zip(names, middles, strict=True)
    }
    settings = {f"{robot}/world_model": dict(NOISE) for robot in places}
    ball = {"x_m": side * 6.4, "y_m": side * 1.0}
    return system_of(Scenario(robots=list(places), places=places, ball=ball, seed=seed, settings=settings))


@pytest.mark.slow
@pytest.mark.parametrize("colour", ["cyan", "magenta"])
def test_ten_robots_score(colour: str) -> None:
    for seed in range(1, CHANCES + 1):
        system = chance(colour, seed)
        for _ in range(CHANCE_S):
            states, _ = play(system, 1.0)
            if getattr(states[-1], f"score_{colour}"):
                return
    pytest.fail(f"{colour} had {CHANCES} chances and did not score")


@pytest.mark.slow
def test_keeper_saves_shots_that_it_can_reach() -> None:
    for y_m in (-0.8, 0.0, 0.8):
        system = match(["cyan1", "cyan2"], 1, {}, starts={"cyan2": (9.0, 6.0, 0.0)})
        system.tick(120)  # until the game state is that of play, in which goals count
        ball = system.runners["world/simulator"].component._world.ball  # type: ignore[attr-defined]
        ball.put(-4.5, 0.5)
        ball.body.velocity = (-5.0, 5.0 * (y_m - 0.5) / 6.5)
        states, _ = play(system, 2.0)
        assert states[-1].score_magenta == 0, f"shot at {y_m} m"


@pytest.mark.slow
def test_same_seed_gives_the_same_match_byte_by_byte() -> None:
    robots = team("cyan", 2) + team("magenta", 2)
    first, second = (match(robots, 5, NOISE) for _ in range(2))
    for system in (first, second):
        system.tick(160)
    assert first.sent == second.sent
    other = match(robots, 6, NOISE)
    other.tick(20)
    assert other.sent != first.sent

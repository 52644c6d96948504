"""Robots whose names say neither team nor number play as the setting `players` states."""

import math
from pathlib import Path
from typing import Any

import pytest

from fwk.model.errors import PlanError
from fwk.testing import Bench, MemorySystem, launch_plan
from lcmtypes.soccer import (
    ball_estimate_t,
    drive_target_t,
    game_state_t,
    mate_estimate_t,
    world_model_t,
)
from procs.behaviour import greedy, roles
from procs.behaviour.agent import Agent
from procs.behaviour.game import Game
from procs.behaviour.navigator import Navigator
from procs.behaviour.obstacles import movers
from procs.behaviour.skiller import Skiller
from procs.behaviour.view import Frame, View, view_of
from procs.model.field import Field
from procs.model.game_states import State
from procs.model.robot import Player
from procs.scenarios.file import Scenario
from procs.scenarios.scenario import system_of

PLAYERS = {
    "zoe": Player(team="cyan", number=1),
    "anna": Player(team="cyan", number=2),
    "bert": Player(team="magenta", number=1),
    "carl": Player(team="magenta", number=2),
}
STATED = {name: player.model_dump() for name, player in PLAYERS.items()}
PARTS = ("agent", "skiller", "navigator")
FIELD = Field()
LAUNCH = Path("launch").resolve()
MINE = """
from fwk import Calls, Component, Writes
from lcmtypes.soccer import role_t, skill_command_t


class MyAgent(Component):
    stage = "think"
    role: Writes[role_t]
    skill: Calls[skill_command_t]
"""
TRUTH = f"include: [{LAUNCH}/msl-field.yaml, {LAUNCH}/msl-truth.yaml]\nname: names\n"


def model_of(mate: str, x_m: float, speed_m_s: float = 0.0) -> world_model_t:
    """Returns the world model of a localized robot that has one mate, at (x_m, 0)."""
    estimate = mate_estimate_t(name=mate, x_m=x_m, vx_m_s=speed_m_s, role="defender")
    return world_model_t(localized=True, mates=[estimate], n_mates=1)


def seen_by(robot: str, mate: str) -> View:
    return view_of(model_of(mate, -5.0), robot, "", Frame(1.0), players=PLAYERS)


@pytest.mark.parametrize(("robot", "mate"), [("zoe", "anna"), ("anna", "zoe")])
def test_lowest_number_of_the_players_keeps_the_goal(robot: str, mate: str) -> None:
    jobs = roles.assign(seen_by(robot, mate), FIELD)
    assert jobs["zoe"].role == roles.GOALKEEPER
    assert jobs["anna"].role == roles.ATTACKER


def test_greedy_keeper_is_number_one_of_the_players() -> None:
    play = Game(State.PLAY, stopped=False)
    found = [greedy.decide(seen_by(name, "anna"), play, False, FIELD)[0] for name in ("zoe", "carl")]
    assert found[0] == roles.GOALKEEPER
    assert found[1] != roles.GOALKEEPER


def test_number_in_the_world_model_precedes_the_players() -> None:
    model = model_of("anna", -5.0)
    model.mates[0].number = 7
    assert view_of(model, "zoe", "", Frame(1.0), players=PLAYERS).mates[0].number == 7


@pytest.mark.parametrize("number", [0, -5])
def test_number_below_one_is_that_of_the_players(number: int) -> None:
    model = model_of("anna", -5.0)
    model.mates[0].number = number
    jobs = roles.assign(view_of(model, "zoe", "", Frame(1.0), players=PLAYERS), FIELD)
    assert jobs["zoe"].role == roles.GOALKEEPER


@pytest.mark.parametrize(("own", "mate", "gives_way"), [("zoe", "anna", True), ("anna", "zoe", False)])
def test_mate_with_the_higher_number_gives_way(own: str, mate: str, gives_way: bool) -> None:
    (mover,) = movers(model_of(mate, 2.0, -1.0), 0.1, PLAYERS[own].number, PLAYERS)
    assert mover.gives_way == gives_way


@pytest.mark.parametrize(("name", "goal_m"), [("anna", 11.0), ("carl", -11.0)])
def test_agent_attacks_the_goal_of_the_other_players(name: str, goal_m: float) -> None:
    bench = Bench(Agent, f"{name}/agent", players=STATED)
    place_m = math.copysign(5.0, goal_m)
    ball = ball_estimate_t(known=True, x_m=place_m)
    for _ in range(6):
        bench.port("world_model").put(localized=True, x_m=place_m, heading_rad=0.0, ball=ball)
        bench.port("game_state").put(state=game_state_t.PLAY)
        bench.port("kicker_state").put(ball_held=True)
        bench.iterate()
    assert bench.skill.sent[-1].x_m == goal_m


@pytest.mark.parametrize(("name", "sign"), [("anna", 1.0), ("carl", -1.0)])
def test_skiller_marks_before_the_goal_of_its_player(name: str, sign: float) -> None:
    bench = Bench(Skiller, f"{name}/skiller", players=STATED)
    bench.skill.put(skill="mark", x_m=sign * -5.0)
    bench.port("world_model").put(localized=True)
    bench.iterate()
    assert bench.port("drive_target").sent[-1].x_m == pytest.approx(sign * -5.9)


@pytest.mark.parametrize(("name", "mate", "role"), [("anna", "zoe", roles.ATTACKER), ("zoe", "anna", roles.GOALKEEPER)])
def test_agent_takes_the_role_of_its_number(name: str, mate: str, role: str) -> None:
    bench = Bench(Agent, f"{name}/agent", players=STATED)
    bench.port("world_model").put(model_of(mate, -5.0))
    bench.port("game_state").put(state=game_state_t.PLAY)
    bench.iterate()
    assert bench.port("role").sent[-1].role == role


@pytest.mark.parametrize(("name", "mate", "y_m"), [("anna", "zoe", -3.85), ("zoe", "anna", 3.15)])
def test_skiller_searches_the_share_of_its_number(name: str, mate: str, y_m: float) -> None:
    bench = Bench(Skiller, f"{name}/skiller", players=STATED)
    bench.skill.put(skill="search")
    for _ in range(20):
        bench.port("world_model").put(model_of(mate, -5.0))
        bench.iterate()
    assert bench.port("drive_target").sent[-1].y_m == pytest.approx(y_m)


def test_navigator_drives_on_before_a_mate_of_higher_number() -> None:
    speeds_m_s = {}
    for name, mate in (("anna", "zoe"), ("zoe", "anna")):
        bench = Bench(Navigator, f"{name}/navigator", players=STATED)
        for _ in range(20):
            model = model_of(mate, 2.5, -1.0)
            for port, message in (("world_model", model), ("drive_target", drive_target_t(x_m=5.0, avoid_robots=True))):
                message.header.time_us = bench.time_us
                bench.port(port).put(message)
            bench.iterate()
        speeds_m_s[name] = bench.port("motor_command").sent[-1].vx_m_s
    assert speeds_m_s["zoe"] > speeds_m_s["anna"] + 0.2


def played(robots: dict[str, tuple[float, float, float]], ball_x_m: float) -> MemorySystem:
    """Returns a match of robots with their starts; the ball lies at (ball_x_m, 0)."""
    parts = ["world/simulator", "world/referee", *(f"{robot}/{part}" for robot in robots for part in PARTS)]
    settings: dict[str, dict[str, Any]] = {part: {"players": STATED} for part in parts}
    return system_of(Scenario(robots=list(robots), places=robots, ball={"x_m": ball_x_m}, settings=settings))


def test_two_robots_with_other_names_score_for_their_teams() -> None:
    """Carl of magenta has the chance at negative x, and Anna of cyan the kick-off after it."""
    system = played({"anna": (3.0, 4.0, 0.0), "carl": (-5.0, 0.0, math.pi)}, -5.8)
    scores = []
    for _ in range(160):
        system.tick()
        state: game_state_t = system.newest("world/game_state")
        scores.append((state.score_cyan, state.score_magenta))
    assert list(dict.fromkeys(scores)) == [(0, 0), (0, 1), (1, 1)]


@pytest.mark.parametrize("robot", ["red1", "anna", "cyan", "cyan0"])
def test_robot_with_an_agent_has_to_be_a_player(robot: str, tmp_path: Path) -> None:
    file = tmp_path / "names.yaml"
    file.write_text(f"{TRUTH}robots: {{{robot}: {{use: msl_robot_truth}}}}\n")
    with pytest.raises(
        PlanError,
        match=rf"{robot}/agent \(and 1 more\): players: {robot} is not a player; add players\.{robot} under 'shared:'",
    ):
        launch_plan(str(file))
    file.write_text(f"{file.read_text()}shared: {{players: {{{robot}: {{team: magenta, number: 9}}}}}}\n")
    launch_plan(str(file))


def test_robot_with_an_agent_of_its_own_has_to_be_a_player(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(MINE)
    parts = "".join(f"    {part}: {{use: procs.behaviour.{part}}}\n" for part in ("skiller", "navigator"))
    parts += "".join(f"    {part}: {{use: procs.drivers.{part}}}\n" for part in ("base", "kicker"))
    parts += "    world_model: {use: procs.scenarios.perfect_world}\n    agent: {use: mine}\n"
    file = tmp_path / "names.yaml"
    file.write_text(f"{TRUTH}templates:\n  mine:\n{parts}robots: {{red1: {{use: mine}}}}\n")
    with pytest.raises(
        PlanError, match=r"red1/skiller: players: red1 is not a player; add players\.red1 under"
    ) as caught:
        launch_plan(str(file))
    assert len(caught.value.problems) == 1
    file.write_text(f"{file.read_text()}shared: {{players: {{red1: {{team: magenta, number: 9}}}}}}\n")
    launch_plan(str(file))

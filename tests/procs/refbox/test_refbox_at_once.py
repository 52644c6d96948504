"""Commands by hand that reach the referee in one tick: base stations hear of each of them, in order."""

import contextlib

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import true_robot_t
from procs.refbox.server import RefBoxServer
from procs.referee.referee import Referee
from tests.procs.refbox.base_station import BaseStation


def heard_of(*ticks: str) -> list[str]:
    """Returns what a base station hears of commands in play; those of a tick are a text such as `stop, goal cyan`."""
    referee = Bench(Referee, "world/referee", automatic=False)
    server = Bench(RefBoxServer, "world/refbox", port=0)

    def tick(*asked: str) -> None:
        for each in asked:
            name, _, whose = each.partition(" ")
            referee.port("referee_command").put(name=name, **{"robot" if whose[-1:].isdigit() else "team": whose})
        referee.port("ground_truth").put(robots=[true_robot_t(name=name) for name in ("cyan2", "magenta3")])
        written = {name: len(referee.port(name).sent) for name in ("match_history", "game_state")}
        referee.iterate()
        for name, before in written.items():
            for message in referee.port(name).sent[before:]:
                server.port(name).put(message)
        server.iterate()

    with contextlib.closing(BaseStation(server.component.port)) as station:
        for _ in range(3):
            tick()
        tick("start")
        begun = ["WELCOME", "RESET", "FIRST_HALF", "KICKOFF 1", "START"]
        for commands in ticks:
            tick(*commands.split(", "))
        tick("end_game")
        heard: list[str] = []
        while heard[-1:] != ["END_GAME"]:
            (each,) = station.heard(1)
            robot = f" {each['robotID']}" if "robotID" in each else ""
            heard.append(f"{each['command']} {each['targetTeam'][-1:]}{robot}".strip())
    server.finalize()
    assert heard[:5] == begun
    return heard[5:]


@pytest.mark.parametrize(
    ("commands", "told"),
    [
        ("stop, start", "STOP, KICKOFF 1, START"),
        ("kickoff magenta, start", "STOP, KICKOFF 2, START"),
        ("stop, throwin magenta, freekick cyan", "STOP, KICKOFF 1, THROWIN 2, FREEKICK 1"),
        ("corner cyan, corner cyan", "STOP, CORNER 1, CORNER 1"),
        ("goal cyan, subgoal cyan", "GOAL 1, STOP, KICKOFF 2, SUBGOAL 1"),
        ("goal cyan, goal magenta, red_card cyan2", "GOAL 1, STOP, KICKOFF 2, GOAL 2, KICKOFF 1, RED_CARD 1 2"),
        ("red_card magenta3, goal cyan", "RED_CARD 2 3, GOAL 1, STOP, KICKOFF 2"),
        ("repair cyan2, substitution cyan2", "REPAIR 1 2, SUBSTITUTION 1 2"),
        ("second_half, start", "STOP, SECOND_HALF, KICKOFF 2, START"),
        ("half_time, second_half, start", "STOP, HALF_TIME, SECOND_HALF, KICKOFF 2, START"),
        ("goal cyan, reset, goal magenta", "GOAL 1, STOP, KICKOFF 2, RESET, FIRST_HALF, KICKOFF 1, GOAL 2"),
        ("goal cyan, corner nobody, goal cyan", "GOAL 1, STOP, KICKOFF 2, GOAL 1"),
    ],
)
def test_commands_of_a_tick_are_all_told(commands: str, told: str) -> None:
    assert heard_of(commands) == [*told.split(", "), "STOP", "END_GAME"]


@pytest.mark.parametrize(
    ("ticks", "told"),
    [
        (
            ["half_time", "kickoff cyan", "second_half"],
            "STOP, HALF_TIME, SECOND_HALF, KICKOFF 1, SECOND_HALF, KICKOFF 1",
        ),
        (["stop, kickoff magenta", "first_half"], "STOP, KICKOFF 1, KICKOFF 2, FIRST_HALF, KICKOFF 1"),
        (
            ["half_time, second_half", "second_half, start"],
            "STOP, HALF_TIME, SECOND_HALF, KICKOFF 2, SECOND_HALF, KICKOFF 2, START",
        ),
    ],
)
def test_half_that_begins_again_is_told_with_its_kick_off(ticks: list[str], told: str) -> None:
    """The other whistles of the half are void, so a base station could not know which team kicks off."""
    assert heard_of(*ticks) == [*told.split(", "), "STOP", "END_GAME"]

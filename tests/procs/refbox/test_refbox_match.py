"""A match led by a RefBox, with the commands and the order that the league's program has, as in its public records."""

import socket
from collections.abc import Iterator

import pytest

from fwk.testing import MemorySystem
from lcmtypes.soccer import game_event_t, game_state_t
from procs.refbox.client import RefBoxClient
from procs.referee.referee import Referee
from procs.scenarios.dummy import Dummy
from procs.simulation.simulator import Simulator
from tests.procs.refbox.base_station import say

CYAN, MAGENTA = "224.16.32.1", "224.16.32.2"
NONE, OURS, THEIRS = game_state_t.TEAM_NONE, game_state_t.TEAM_CYAN, game_state_t.TEAM_MAGENTA
KICK_OFF, PENALTY, THROW_IN = game_state_t.KICK_OFF, game_state_t.PENALTY, game_state_t.THROW_IN
HALF_TIME, FROZEN = game_state_t.HALF_TIME, game_state_t.FROZEN


class Match:
    """Robots, a referee that only obeys, and a RefBox at the other end of a TCP connection."""

    def __init__(self, listening: socket.socket) -> None:
        robots = [f"{team}{number}/dummy" for team in ("cyan", "magenta") for number in (1, 2, 3)]
        self.system = MemorySystem(
            {"world/refbox": RefBoxClient, "world/referee": Referee, "world/simulator": Simulator}
            | dict.fromkeys(robots, Dummy),
            settings={
                "world/refbox": {"port": listening.getsockname()[1]},
                "world/referee": {"automatic": False},
            },
        )
        self.system.tick()
        self.connection, _ = listening.accept()
        self.connection.settimeout(5.0)

    def command(self, *messages: bytes) -> tuple[int, int, bool, int]:
        """Sends commands at one time; returns state, team, whether the game is stopped, and the half."""
        asked = "world/referee_command@world/refbox"
        before = len(self.system.sent[asked])
        self.connection.sendall(b"".join(messages))
        for _ in range(200):
            self.system.tick()
            if len(self.system.sent[asked]) >= before + len(messages):
                break
        self.system.tick(20)
        game: game_state_t = self.system.newest("world/game_state")
        return game.state, game.state_team, game.stopped, game.half

    @property
    def game(self) -> game_state_t:
        """The newest state."""
        newest: game_state_t = self.system.newest("world/game_state")
        return newest


@pytest.fixture
def match() -> Iterator[Match]:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(5.0)
        match = Match(listening)
        yield match
        match.connection.close()
        match.system.runners["world/refbox"].component.finalize()
    assert not [line.text for line in match.system.logged if "does not obey" in line.text or "RefBox:" in line.text]


def test_refbox_leads_a_match_to_the_last_penalty(match: Match) -> None:
    assert match.command(say("STOP")) == (KICK_OFF, OURS, True, 1)
    assert match.command(say("KICKOFF", MAGENTA)) == (KICK_OFF, THEIRS, True, 1)
    assert match.command(say("FIRST_HALF"), say("START")) == (KICK_OFF, THEIRS, False, 1)
    assert match.game.time_in_half_s < 2.0
    assert match.command(say("STOP")) == (KICK_OFF, THEIRS, True, 1)
    assert match.command(say("THROWIN", CYAN)) == (THROW_IN, OURS, True, 1)
    assert match.command(say("START")) == (THROW_IN, OURS, False, 1)
    assert match.command(say("STOP")) == (THROW_IN, OURS, True, 1)
    assert match.command(say("HALF_TIME")) == (HALF_TIME, NONE, True, 1)
    assert match.command(say("KICKOFF", CYAN)) == (KICK_OFF, OURS, True, 2), "robots change ends in the break"
    assert match.game.cyan_side == 1
    assert match.command(say("SECOND_HALF"), say("START")) == (KICK_OFF, OURS, False, 2)
    match.command(say("STOP"))
    assert match.command(say("GOAL", MAGENTA)) == (KICK_OFF, OURS, True, 2)
    assert match.command(say("KICKOFF", CYAN)) == (KICK_OFF, OURS, True, 2)
    match.command(say("START"))
    match.command(say("STOP"))
    match.command(say("GOAL", CYAN))
    assert match.command(say("END_GAME")) == (FROZEN, NONE, True, 2)
    assert match.command(say("KICKOFF", CYAN)) == (KICK_OFF, OURS, True, 3)
    assert match.command(say("FIRST_HALF_OVERTIME"), say("START")) == (KICK_OFF, OURS, False, 3)
    match.command(say("STOP"))
    assert match.command(say("HALF_TIME")) == (HALF_TIME, NONE, True, 3)
    assert match.command(say("KICKOFF", MAGENTA)) == (KICK_OFF, THEIRS, True, 4)
    assert match.command(say("SECOND_HALF_OVERTIME"), say("START")) == (KICK_OFF, THEIRS, False, 4)
    match.command(say("STOP"))
    assert match.command(say("END_GAME")) == (FROZEN, NONE, True, 4)
    for goals in (1, 2):  # one team after the other, not by turns
        assert match.command(say("PENALTY", MAGENTA)) == (PENALTY, THEIRS, True, 5)
        assert match.command(say("START")) == (PENALTY, THEIRS, False, 5)
        assert match.command(say("STOP")) == (PENALTY, THEIRS, True, 5)
        match.command(say("GOAL", MAGENTA))
        assert match.game.score_magenta == 1 + goals
    assert match.command(say("PENALTY", MAGENTA), say("STOP")) == (PENALTY, THEIRS, True, 5)
    assert match.command(say("PENALTY", CYAN)) == (PENALTY, OURS, True, 5)
    match.command(say("START"))
    match.command(say("STOP"))
    assert match.command(say("PENALTY", CYAN)) == (PENALTY, OURS, True, 5), "missed, and shoots again"
    assert match.command(say("GAMEOVER")) == (FROZEN, NONE, True, 5)
    assert (match.game.score_cyan, match.game.score_magenta) == (1, 3)
    assert match.command(say("RESET")) == (KICK_OFF, OURS, True, 1)


def test_cards_of_a_refbox_name_no_robot(match: Match) -> None:
    for command in ("YELLOW_CARD", "DOUBLE_YELLOW", "RED_CARD", "REPAIR"):
        match.command(say(command, CYAN if command == "REPAIR" else MAGENTA))
    assert match.game.sent_off == ["cyan3", "magenta2", "magenta3"]
    events = match.system.newest("world/match_history").events
    assert [(each.robot, each.card) for each in events if each.card] == [
        ("magenta3", game_event_t.YELLOW),
        ("magenta3", game_event_t.DOUBLE_YELLOW),
        ("magenta2", game_event_t.RED),
    ]


def test_news_of_a_refbox_that_ask_for_nothing_are_passed_over(match: Match) -> None:
    news = [say(" WELCOME", CYAN), say("IS_ALIVE", CYAN, robotID=3), say("REPAIR_END", CYAN), say("TESTMODE_ON")]
    assert match.command(*news, say("STOP"), say("DROP_BALL")) == (game_state_t.DROP_BALL, NONE, True, 1)

"""The RefBox protocol: bytes, and commands between states of the game."""

import pytest
from pydantic import ValidationError

from lcmtypes.soccer import game_event_t, game_state_t
from procs.model.game_states import State
from procs.model.teams import Team
from procs.refbox.news import news
from procs.refbox.protocol import LONGEST, Addresses, Command, ProtocolError, Stream, decode, encode
from procs.referee.orders import carry_out
from procs.referee.reasons import Reason
from procs.referee.sight import Sight
from tests.procs.referee.script import Script

ADDRESSES = Addresses().model_dump()


def state(kind: int, team: int = 0, stopped: bool = True, **more: float) -> game_state_t:
    made = game_state_t()
    made.state, made.state_team, made.stopped, made.half = kind, team, stopped, 1
    for name, value in more.items():
        setattr(made, name, value)
    return made


KICK_OFF = state(game_state_t.KICK_OFF, game_state_t.TEAM_CYAN)
PLAY = state(game_state_t.PLAY, stopped=False)


@pytest.mark.parametrize(
    ("command", "data"),
    [
        (Command("START"), b'{"command": "START", "targetTeam": ""}\0'),
        (Command("KICKOFF", "magenta"), b'{"command": "KICKOFF", "targetTeam": "224.16.32.2"}\0'),
        (Command("RED_CARD", "cyan", 3), b'{"command": "RED_CARD", "targetTeam": "224.16.32.1", "robotID": 3}\0'),
    ],
)
def test_command_as_bytes_and_back(command: Command, data: bytes) -> None:
    assert encode(command, ADDRESSES) == data
    assert decode(data[:-1], ADDRESSES) == command


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"STOP", "b'STOP' is not JSON"),
        (b"[1]", "b'[1]' has no command"),
        (b'{"targetTeam": ""}', "has no command"),
        (b'{"command": "GOAL", "targetTeam": "10.0.0.1"}', "no team has the address '10.0.0.1'; there are 224"),
        (b'{"command": "REPAIR", "robotID": -1}', "-1 is not the number of a robot"),
        (b'{"command": "REPAIR", "robotID": true}', "True is not the number of a robot"),
        (b'{"command": "REPAIR", "robotID": "' + b"9" * 5000 + b'"}', "'9{59} is not the number of a robot"),
        (b'{"command": "GOAL", "targetTeam": ["224.16.32.1"]}', "no team has the address .'224.16.32.1'.; there are"),
        (b'{"command": "GOAL", "targetTeam": {}}', "no team has the address {}; there are"),
        (b'{"command": "\\ud800"}', "is not the name of a command"),
        (b'{"command": "A\\u0000B"}', "is not the name of a command"),
        (b'{"command": "' + b"x" * 60_000 + b'"}', "'x{59} is not the name of a command"),
        (b"[" * 60_000, "is not JSON"),
        (b"\xff\xfe\x80", "is not JSON"),
        (b"NaN", "is not JSON"),
    ],
)
def test_bytes_that_are_no_command(data: bytes, message: str) -> None:
    with pytest.raises(ProtocolError, match=message.replace("[", r"\[")):
        decode(data, ADDRESSES)


def test_address_of_one_team_leaves_that_of_the_other() -> None:
    addresses = Addresses(cyan="224.16.32.9").model_dump()
    assert addresses == {"cyan": "224.16.32.9", "magenta": "224.16.32.2"}
    with pytest.raises(ValidationError, match=r"both teams have the address 224\.16\.32\.2; give each its own"):
        Addresses(cyan="224.16.32.2")


def test_stream_is_cut_at_nul_bytes_wherever_they_arrive() -> None:
    stream = Stream()
    assert [list(stream.feed(part)) for part in (b"ab", b"c\0d", b"\0\0e\0")] == [[], [b"abc"], [b"d", b"e"]]
    with pytest.raises(ProtocolError, match="without a NUL"):
        list(stream.feed(b"x" * (LONGEST + 1)))


@pytest.mark.parametrize(
    ("before", "now", "names"),
    [
        (None, KICK_OFF, ["FIRST_HALF", "KICKOFF cyan"]),
        (None, PLAY, ["FIRST_HALF", "START"]),
        (None, state(game_state_t.HALF_TIME), ["FIRST_HALF", "STOP", "HALF_TIME"]),
        (None, state(game_state_t.FROZEN, half=2), ["SECOND_HALF", "STOP", "END_GAME"]),
        (None, state(1, stopped=False, score_cyan=2), ["FIRST_HALF", "GOAL cyan", "GOAL cyan", "START"]),
        (KICK_OFF, KICK_OFF, []),
        (KICK_OFF, state(game_state_t.KICK_OFF, 1, stopped=False), ["START"]),
        (PLAY, state(game_state_t.THROW_IN, 2), ["STOP", "THROWIN magenta"]),
        (PLAY, state(game_state_t.DROP_BALL), ["STOP", "DROP_BALL"]),
        (PLAY, state(game_state_t.KICK_OFF, 2, score_cyan=1), ["GOAL cyan", "STOP", "KICKOFF magenta"]),
        (state(1, score_cyan=1), state(1), ["SUBGOAL cyan"]),
        (PLAY, state(game_state_t.HALF_TIME), ["STOP", "HALF_TIME"]),
        (PLAY, state(game_state_t.FROZEN), ["STOP", "END_GAME", "GAMEOVER"]),
        (state(1, half=2), state(game_state_t.FROZEN, half=2), ["STOP", "END_GAME"]),  # drawn: overtime may follow
        (state(1, half=2), state(game_state_t.HALF_TIME, half=2), ["STOP", "END_GAME"]),
        (state(1, half=3), state(game_state_t.HALF_TIME, half=3), ["STOP", "HALF_TIME"]),
        (
            state(1, half=2, score_cyan=1),
            state(game_state_t.FROZEN, half=2, score_cyan=1),
            ["STOP", "END_GAME", "GAMEOVER"],
        ),
        (state(game_state_t.HALF_TIME), state(game_state_t.KICK_OFF, 2, half=2), ["SECOND_HALF", "KICKOFF magenta"]),
        (
            state(game_state_t.FROZEN, half=2),
            state(game_state_t.KICK_OFF, 2, half=2),
            ["SECOND_HALF", "KICKOFF magenta"],
        ),
        (KICK_OFF, state(game_state_t.KICK_OFF, 2, stopped=False), ["KICKOFF magenta", "START"]),  # at once
        (
            state(game_state_t.HALF_TIME, half=2),
            state(game_state_t.PENALTY, 1, half=5),
            ["SECOND_HALF_OVERTIME", "STOP", "END_GAME", "PENALTY cyan"],
        ),
        (
            state(game_state_t.PENALTY, 1),
            state(game_state_t.PENALTY, 1, half=5, stopped=False),
            ["SECOND_HALF_OVERTIME", "STOP", "END_GAME", "PENALTY cyan", "START"],
        ),
        (state(game_state_t.FROZEN, half=4), state(game_state_t.PENALTY, 2, half=5), ["PENALTY magenta"]),
        (
            state(game_state_t.FROZEN, half=5, score_cyan=1),
            state(game_state_t.PENALTY, 2, half=5, score_cyan=1),
            ["RESET", "SECOND_HALF_OVERTIME", "STOP", "END_GAME", "PENALTY cyan", "GOAL cyan", "PENALTY magenta"],
        ),  # after GAMEOVER, which only RESET follows
        (
            state(game_state_t.FROZEN, half=2, score_cyan=1),
            state(game_state_t.KICK_OFF, 2, half=2, score_cyan=1),
            ["RESET", "SECOND_HALF", "GOAL cyan", "KICKOFF magenta"],
        ),
        (
            state(game_state_t.FROZEN, half=2, score_cyan=1),
            state(game_state_t.FROZEN, half=2),
            ["RESET", "SECOND_HALF", "STOP", "END_GAME"],
        ),  # drawn by hand: overtime may follow
        (
            state(game_state_t.FROZEN, half=2),
            state(game_state_t.FROZEN, half=2, score_cyan=1),
            ["GOAL cyan", "GAMEOVER"],
        ),  # decided by hand
        (
            state(game_state_t.FROZEN, half=2, score_cyan=1),
            state(game_state_t.FROZEN, half=2, score_cyan=2),
            ["GOAL cyan"],
        ),
        (PLAY, state(game_state_t.KICK_OFF, 2, half=2), ["STOP", "SECOND_HALF", "KICKOFF magenta"]),
        (
            PLAY,
            state(game_state_t.PENALTY, 1, half=5),
            ["STOP", "SECOND_HALF_OVERTIME", "STOP", "END_GAME", "PENALTY cyan"],
        ),
        (
            state(game_state_t.THROW_IN, 1, half=2, time_in_half_s=9.0),
            state(game_state_t.KICK_OFF, 2, half=2),
            ["SECOND_HALF", "KICKOFF magenta"],
        ),
    ],
)
def test_commands_between_states(before: game_state_t | None, now: game_state_t, names: list[str]) -> None:
    assert [f"{command.name} {command.team}".strip() for command in news(before, now)] == names


def test_card_names_team_and_robot() -> None:
    now, event = state(game_state_t.PLAY, stopped=False, decisions=1), game_event_t()
    event.card, event.team, event.robot = game_event_t.DOUBLE_YELLOW, game_state_t.TEAM_MAGENTA, "magenta4"
    assert news(PLAY, now, [event]) == [Command("DOUBLE_YELLOW", "magenta", 4)]
    assert news(now, now, [event]) == []


def test_match_that_begins_anew_is_a_reset() -> None:
    before = state(game_state_t.PLAY, stopped=False, score_cyan=2, decisions=2)
    now = state(game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, decisions=1)
    assert [command.name for command in news(before, now, [game_event_t()])] == ["RESET", "FIRST_HALF", "KICKOFF"]


def test_reset_before_anything_happened_is_told() -> None:
    kick_off, reset = game_event_t(), game_event_t()
    reset.reason = Reason.RESET
    before = state(game_state_t.KICK_OFF, 1, decisions=1, time_in_half_s=3.0)
    now = state(game_state_t.KICK_OFF, 1, decisions=1)
    assert [command.name for command in news(before, now, [reset])] == ["RESET", "FIRST_HALF", "KICKOFF"]
    again = state(game_state_t.KICK_OFF, 1, decisions=2)
    begun = [Command("FIRST_HALF"), Command("KICKOFF", "cyan")]
    assert news(before, again, [reset, kick_off]) == begun, "another first half is not a reset"


def left(robot: str, reason: str, card: int = 0) -> game_event_t:
    event = game_event_t()
    event.robot, event.reason, event.card = robot, reason, card
    return event


@pytest.mark.parametrize(
    ("events", "sent_off", "told"),
    [
        ([left("cyan3", Reason.SUBSTITUTION)], ["cyan3"], [Command("SUBSTITUTION", "cyan", 3)]),
        (
            [left("cyan3", Reason.REPAIR)],
            ["cyan3", "cyan4"],
            [Command("REPAIR", "cyan", 3), Command("REPAIR", "cyan", 4)],
        ),
        ([left("", Reason.PARK)], ["cyan3", "magenta2"], [Command("PARK")]),
        ([left("", Reason.PARK), left("cyan3", Reason.SUBSTITUTION)], ["cyan3"], [Command("SUBSTITUTION", "cyan", 3)]),
        ([left("cyan3", Reason.SUBSTITUTION), left("cyan3", Reason.REPAIR)], ["cyan3"], [Command("REPAIR", "cyan", 3)]),
        ([left("cyan3", Reason.SUBSTITUTION), left("", Reason.PARK)], [], []),
    ],
)
def test_robot_leaves_by_the_name_of_the_command(
    events: list[game_event_t], sent_off: list[str], told: list[Command]
) -> None:
    now = state(game_state_t.PLAY, stopped=False, decisions=len(events))
    now.sent_off = sent_off
    assert news(PLAY, now, events) == told
    assert news(now, now, events) == []
    assert news(None, now, events) == [Command("FIRST_HALF"), *told, Command("START")]


def test_robot_off_the_field_without_a_card_is_repaired() -> None:
    now, red = state(game_state_t.PLAY, stopped=False, decisions=1), game_event_t()
    red.card, red.team, red.robot = game_event_t.RED, game_state_t.TEAM_CYAN, "cyan2"
    now.sent_off = ["cyan2", "magenta3"]
    off = [Command("RED_CARD", "cyan", 2), Command("REPAIR", "magenta", 3)]
    assert news(PLAY, now, [red]) == off
    assert news(now, now, [red]) == []
    assert news(None, now, [red]) == [Command("FIRST_HALF"), *off, Command("START")]


def test_newcomer_does_not_send_off_a_robot_that_is_back() -> None:
    cards = (game_event_t.YELLOW, game_event_t.DOUBLE_YELLOW, game_event_t.YELLOW)
    events = [left("cyan2", "", card) for card in cards] + [left("cyan3", "", game_event_t.DOUBLE_YELLOW)]
    for event in events:
        event.team = game_state_t.TEAM_CYAN
    now = state(game_state_t.PLAY, stopped=False, decisions=len(events))
    now.sent_off = ["cyan3"]
    told = [Command("YELLOW_CARD", "cyan", 2), Command("DOUBLE_YELLOW", "cyan", 3)]
    assert news(None, now, events) == [Command("FIRST_HALF"), *told, Command("START")]


def test_robot_with_a_card_parks_no_others() -> None:
    red = left("cyan3", "", game_event_t.RED)
    red.team = game_state_t.TEAM_CYAN
    events = [red, left("", Reason.PARK)]
    now = state(game_state_t.PLAY, stopped=False, decisions=2)
    for away, told in ((["cyan3"], []), (["cyan3", "magenta2"], [Command("PARK")])):
        now.sent_off = away
        assert news(None, now, events) == [
            Command("FIRST_HALF"),
            Command("RED_CARD", "cyan", 3),
            *told,
            Command("START"),
        ]


def test_newcomer_is_told_of_the_deciding_penalties() -> None:
    events = [game_event_t() for _ in range(4)]
    for event, half, team in zip(events, (1, 2, 5, 5), (1, 2, 2, 2), strict=True):
        event.goal, event.half, event.team = True, half, team
    now = state(game_state_t.PENALTY, 1, half=5, score_cyan=1, score_magenta=3, decisions=4)
    told = news(None, now, events)
    penalties = ["PENALTY magenta", "GOAL magenta"] * 2 + ["PENALTY cyan"]
    assert [f"{command.name} {command.team}".strip() for command in told] == [
        "SECOND_HALF_OVERTIME",
        "GOAL cyan",
        "GOAL magenta",
        "STOP",
        "END_GAME",
        *penalties,
    ]
    match = Script(automatic=False).whistle
    assert [carry_out(match, Sight(match.spot), each.name.lower(), each.team) for each in told] == [""] * len(told)
    assert (match.half, match.state, match.team, match.score) == (5, State.PENALTY, Team.CYAN, {1: 1, 2: 3})
    shot = state(game_state_t.PENALTY, 1, half=5, score_cyan=1, score_magenta=3, decisions=4, stopped=False)
    assert news(None, shot, events) == [*told, Command("START")]


def test_newcomer_during_penalties_gets_a_corrected_score() -> None:
    """A goal that was taken back is still in the history."""
    goal = game_event_t()
    goal.goal, goal.half, goal.team = True, 5, 1
    told = news(None, state(game_state_t.PENALTY, 2, half=5, score_cyan=0, score_magenta=1, decisions=1), [goal])
    assert [command.name for command in told if command.team == "magenta"] == ["PENALTY", "GOAL", "PENALTY"]
    assert not any(command.team == "cyan" for command in told)


def test_deciding_goal_taken_back_is_not_told_as_scored() -> None:
    goal = game_event_t(goal=True, team=game_state_t.TEAM_CYAN, half=5)
    taken_back = game_event_t(reason=Reason.SUBGOAL, team=game_state_t.TEAM_CYAN, half=5)
    now = state(game_state_t.PENALTY, 2, half=5, score_cyan=2, score_magenta=2, decisions=2)
    told = [command.name for command in news(None, now, [goal, taken_back])]
    assert told == ["SECOND_HALF_OVERTIME", *["GOAL"] * 4, "STOP", "END_GAME", "PENALTY"]


def test_newcomer_after_the_penalties_is_told_of_them() -> None:
    goals = [game_event_t(goal=True, half=5, team=team) for team in (1, 2, 2)]
    ended = state(game_state_t.FROZEN, half=5, score_cyan=2, score_magenta=3, decisions=3)
    told = news(None, ended, goals)
    assert [f"{command.name} {command.team}".strip() for command in told] == [
        *("SECOND_HALF_OVERTIME", "GOAL cyan", "GOAL magenta", "STOP", "END_GAME"),
        *("PENALTY cyan", "GOAL cyan", *["PENALTY magenta", "GOAL magenta"] * 2),
        *("STOP", "END_GAME", "GAMEOVER"),
    ]
    match = Script(automatic=False).whistle
    assert [carry_out(match, Sight(match.spot), each.name.lower(), each.team) for each in told[:-1]] == [""] * 13
    assert (match.half, match.state, match.score) == (5, State.FROZEN, {1: 2, 2: 3})


def test_follower_goes_on_after_a_draw_by_hand() -> None:
    """The match was decided; the goal is taken back, and the overtime follows."""
    states = [
        state(game_state_t.FROZEN, half=2, score_cyan=1),
        state(game_state_t.FROZEN, half=2),
        state(game_state_t.KICK_OFF, 1, half=3),
    ]
    match = Script(automatic=False).whistle
    for before, now in zip([None, *states], states, strict=False):
        for command in news(before, now):
            name = "end_game" if command.name == "GAMEOVER" else command.name.lower()
            assert carry_out(match, Sight(match.spot), name, command.team) == ""
        score = match.score[Team.CYAN], match.score[Team.MAGENTA]
        assert (match.state, match.half, score) == (now.state, now.half, (now.score_cyan, now.score_magenta))

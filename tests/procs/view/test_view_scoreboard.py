"""The score in words."""

from typing import Any

import pytest

from lcmtypes.soccer import game_event_t, game_state_t, match_history_t
from procs.view.scoreboard import STATES, headline, play_time, summary


def state(**fields: Any) -> game_state_t:
    made = game_state_t()
    made.half, made.state = 1, game_state_t.PLAY
    for name, value in fields.items():
        setattr(made, name, value)
    return made


def summary_of(state: game_state_t, *events: game_event_t) -> list[str]:
    return summary({"world/game_state": state, "world/match_history": match_history_t(events=[*events])}.get)


def test_headline_of_a_match() -> None:
    now = state(score_cyan=2, score_magenta=1, time_in_half_s=192.9)
    newest = {"world/game_state": now}.get
    assert headline(newest) == "CYAN 2 : 1 MAGENTA   half 1  03:12   play"


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"state": game_state_t.THROW_IN, "state_team": game_state_t.TEAM_MAGENTA}, "throw-in magenta"),
        ({"state": game_state_t.KICK_OFF, "state_team": 1, "stopped": True}, "kick-off cyan, taking positions"),
        ({"state": game_state_t.DROP_BALL}, "dropped ball"),
        ({"state": game_state_t.HALF_TIME, "stopped": True}, "half time"),
        ({"state": 77}, "state 77"),
    ],
)
def test_state_of_the_game_in_words(fields: dict[str, Any], words: str) -> None:
    assert headline(lambda _: state(**fields)).endswith(f"   {words}")


def test_every_state_has_a_name() -> None:
    states = {value for name, value in vars(game_state_t).items() if name.isupper() and not name.startswith("TEAM")}
    assert set(STATES) == states


def test_without_a_referee_there_is_no_headline() -> None:
    assert headline(lambda _: None) == ""
    assert summary(lambda _: None) == []


@pytest.mark.parametrize(
    ("cyan", "magenta", "words"), [(1, 0, "cyan leads"), (0, 3, "magenta leads"), (2, 2, "a draw")]
)
def test_summary_names_the_leader(cyan: int, magenta: int, words: str) -> None:
    now = state(score_cyan=cyan, score_magenta=magenta, half=2, time_in_half_s=900.0)
    assert summary_of(now) == [f"CYAN {cyan} : {magenta} MAGENTA", f"{words} after 15:00 of half 2"]


@pytest.mark.parametrize("half", [1, 2])
def test_after_the_final_whistle_the_summary_names_the_winner(half: int) -> None:
    now = state(score_cyan=2, score_magenta=1, half=half, state=game_state_t.FROZEN, time_in_half_s=900.0)
    assert summary_of(now)[1] == f"cyan wins after 15:00 of half {half}"


def test_summary_without_a_history_names_score_and_leader() -> None:
    assert len(summary({"world/game_state": state(score_cyan=1)}.get)) == 2


def test_long_halves_keep_counting_minutes() -> None:
    assert play_time(6000.0) == "100:00"


@pytest.mark.parametrize("time_s", [float("nan"), float("inf"), -1.0, 1e300])
def test_play_time_of_what_is_no_time_is_dashes(time_s: float) -> None:
    assert play_time(time_s) == "--:--"


def test_summary_lists_the_goals_and_counts_the_whistles() -> None:
    events = []
    for goal, kind, team, time_s in [
        (False, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, 0.0),
        (True, game_state_t.PLAY, game_state_t.TEAM_MAGENTA, 19.4),
        (False, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, 19.4),
        (False, game_state_t.CORNER_KICK, game_state_t.TEAM_CYAN, 40.0),
    ]:
        events.append(game_event_t(goal=goal, state=kind, team=team, half=1, time_in_half_s=time_s))
    assert summary_of(state(score_magenta=1), *events)[2:] == [
        "goals: 00:19 magenta",
        "whistles: kick-off 2, corner kick 1",
    ]


def test_summary_lists_the_cards() -> None:
    event = game_event_t(card=game_event_t.YELLOW, robot="cyan3", team=game_state_t.TEAM_CYAN, half=1)
    assert summary_of(state(), event)[2:] == ["cards: yellow cyan3"]


def test_goal_taken_back_is_not_listed() -> None:
    events = [
        game_event_t(goal=True, team=game_state_t.TEAM_CYAN, half=1, time_in_half_s=10.0),
        game_event_t(goal=True, team=game_state_t.TEAM_MAGENTA, half=1, time_in_half_s=20.0),
        game_event_t(reason="subgoal", team=game_state_t.TEAM_CYAN, half=1, time_in_half_s=30.0),
    ]
    assert summary_of(state(score_magenta=1), *events)[2:] == ["goals: 00:20 magenta"]

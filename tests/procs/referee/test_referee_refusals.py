"""Commands by hand that make no sense at the state of the match, and those that correct it."""

import pytest

from procs.model.events import Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.orders import carry_out
from procs.referee.sight import Sight
from tests.procs.referee.script import CYAN, MAGENTA, Script
from tests.procs.referee.test_referee_by_hand import ask

SET_PIECES = ["kickoff", "freekick", "goalkick", "throwin", "corner", "penalty"]


def ended() -> Script:
    script = Script().playing()
    assert ask(script, "end_game") == ""
    return script


def in_break() -> Script:
    script = Script(half_time_s=60.0).playing()
    assert ask(script, "half_time") == ""
    return script


def penalties() -> Script:
    script = Script(penalties=2, decide=True)
    assert ask(script, "penalties") == ""
    return script


def counted(script: Script) -> tuple[list[int], list[int]]:
    """Returns the shots and the goals of the deciding penalties, cyan first."""
    assert script.whistle.shootout
    shots, goals = script.whistle.shootout.shots, script.whistle.shootout.goals
    return [shots[CYAN], shots[MAGENTA]], [goals[CYAN], goals[MAGENTA]]


@pytest.mark.parametrize("command", [*SET_PIECES, "drop_ball", "half_time"])
def test_no_set_piece_after_the_end(command: str) -> None:
    script = ended()
    reason = ask(script, command, "cyan" if command in SET_PIECES else "")
    assert reason.startswith("no ")
    assert reason.endswith(" after the end of the match; reset begins another match")
    assert script.state == (State.FROZEN, 0, True)


@pytest.mark.parametrize("command", [*SET_PIECES[1:], "drop_ball", "half_time"])
def test_only_the_kick_off_in_a_break(command: str) -> None:
    script = in_break()
    reason = ask(script, command, "cyan" if command in SET_PIECES else "")
    assert reason.startswith("no ")
    assert reason.endswith(" in a break; second_half begins the next half")
    assert script.state == (State.HALF_TIME, 0, True)


def test_refusals_name_the_set_piece() -> None:
    assert ask(ended(), "penalty", "cyan").startswith("no penalty after")
    assert ask(ended(), "drop_ball").startswith("no dropped ball after")
    assert ask(in_break(), "freekick", "cyan").startswith("no free kick in")


def test_refused_start_says_what_to_do_instead() -> None:
    assert ask(Script().playing(), "start") == "nothing to start: the game runs; stop or a set piece interrupts it"
    assert ask(in_break(), "start") == "no start in a break; second_half begins the next half"
    assert ask(ended(), "start") == "no start after the end of the match; reset begins another match"


@pytest.mark.parametrize(
    ("half", "following"),
    [
        ("second_half", "first_half_overtime begins the overtime"),
        ("second_half_overtime", "penalties begins the deciding penalties"),
    ],
)
def test_refusal_after_a_draw_names_what_may_follow(half: str, following: str) -> None:
    script = Script()
    ask(script, half)
    ask(script, "end_game")
    assert ask(script, "drop_ball").endswith(f" after the end of the match; {following}, reset another match")
    ask(script, "goal", "cyan")
    assert ask(script, "drop_ball").endswith(" after the end of the match; reset begins another match")


@pytest.mark.parametrize(("half", "command"), [("second_half", "kickoff"), ("second_half_overtime", "penalty")])
def test_break_of_a_decided_match_leads_to_its_end(half: str, command: str) -> None:
    """A goal was counted in the break that a draw has led to."""
    script = Script(decide=True, half_time_s=60.0)
    for name, team in ((half, ""), ("half_time", ""), ("goal", "magenta")):
        assert ask(script, name, team) == ""
    assert ask(script, command, "cyan").endswith(" in a break; end_game ends the match, which is decided")
    assert script.state == (State.HALF_TIME, 0, True)
    ask(script, "goal", "cyan")
    assert ask(script, command, "cyan") == ""


def test_score_is_corrected_without_a_kick_off_in_a_break() -> None:
    for script in (ended(), in_break()):
        before = script.state
        assert ask(script, "goal", "cyan") == ""
        assert (script.score, script.state) == ((1, 0), before)
        assert ask(script, "subgoal", "cyan") == ""
        assert (script.score, script.state) == ((0, 0), before)


def test_no_half_time_without_another_half() -> None:
    script = Script()
    ask(script, "second_half")
    assert ask(script, "half_time") == "no half time: no other half follows; end_game ends the match"
    assert script.state == (State.KICK_OFF, MAGENTA, True)


def test_half_time_before_the_overtime_of_a_draw() -> None:
    script = Script(decide=True, half_time_s=60.0)
    ask(script, "second_half")
    assert ask(script, "half_time") == ""
    assert ask(script, "corner", "cyan").endswith("; first_half_overtime begins the overtime")


def test_goal_by_hand_is_that_of_the_penalty_at_hand() -> None:
    script = penalties()
    assert ask(script, "goal", "cyan") == ""
    assert (script.state, script.score) == ((State.PENALTY, MAGENTA, True), (1, 0))
    assert counted(script) == ([1, 0], [1, 0])
    refused = "cyan cannot score: the penalty is that of magenta; penalty team=cyan gives cyan one"
    assert ask(script, "goal", "cyan") == refused
    assert ask(script, "goal", "magenta") == ""
    assert (script.score, counted(script)) == ((1, 1), ([1, 1], [1, 1]))


def test_goals_by_hand_decide_the_penalties() -> None:
    script = penalties()
    for command, team in (("goal", "cyan"), ("start", ""), ("penalty", "cyan"), ("goal", "cyan")):
        assert ask(script, command, team) == ""
    assert (script.state[0], script.score) == (State.FROZEN, (2, 0)), "magenta missed, and has one penalty left"


def test_goal_of_a_penalty_is_taken_back() -> None:
    script = penalties()
    ask(script, "goal", "cyan")
    assert ask(script, "subgoal", "cyan") == ""
    assert (script.score, counted(script)) == ((0, 0), ([1, 0], [0, 0]))


@pytest.mark.parametrize("automatic", [True, False])
def test_goal_taken_back_decides_the_penalties(automatic: bool) -> None:
    script = penalties()
    for command, team in (("goal", "cyan"), ("start", ""), ("goal", "magenta"), ("start", ""), ("goal", "cyan")):
        assert ask(script, command, team) == ""
    script.whistle.rules = script.whistle.rules.model_copy(update={"automatic": automatic})
    assert ask(script, "subgoal", "magenta") == ""
    assert (script.state[0], script.score) == (State.FROZEN if automatic else State.PENALTY, (2, 0))


@pytest.mark.parametrize("command", ["kickoff", "freekick", "goalkick", "throwin", "corner", "drop_ball"])
def test_only_penalties_while_they_decide_the_match(command: str) -> None:
    script = penalties()
    reason = ask(script, command, "" if command == "drop_ball" else "magenta")
    assert reason.endswith(" while penalties decide the match; penalty team=cyan repeats the one at hand")
    assert (script.state, counted(script)) == ((State.PENALTY, CYAN, True), ([0, 0], [0, 0]))


def test_penalty_of_the_other_team_makes_it_a_miss() -> None:
    script = penalties()
    assert ask(script, "penalty", "magenta") == "", "magenta shoots first"
    assert (script.state, counted(script)) == ((State.PENALTY, MAGENTA, True), ([0, 0], [0, 0]))
    for stopped in (True, False):
        script = penalties()
        script.robots["cyan2"] = Point(6.8, 0.0)
        ask(script, "start")
        script.touch("cyan2", Kind.KICK)
        if stopped:
            ask(script, "stop")
        assert ask(script, "penalty", "magenta") == ""
        assert (script.state, counted(script)) == ((State.PENALTY, MAGENTA, True), ([1, 0], [0, 0]))


@pytest.mark.parametrize("automatic", [True, False])
def test_stop_before_the_start_makes_no_penalty_a_miss(automatic: bool) -> None:
    script = Script(penalties=2, decide=True, automatic=automatic)
    for command, team in (("penalties", ""), ("stop", ""), ("penalty", "magenta")):
        assert ask(script, command, team) == ""
    assert (script.state, counted(script)) == ((State.PENALTY, MAGENTA, True), ([0, 0], [0, 0]))
    for command, team in (("start", ""), ("goal", "magenta"), ("stop", ""), ("penalty", "magenta")):
        assert ask(script, command, team) == ""
    assert (script.state, counted(script)) == ((State.PENALTY, MAGENTA, True), ([0, 1], [0, 1]))


def test_penalty_of_the_same_team_repeats_it() -> None:
    script = penalties()
    ask(script, "start")
    assert ask(script, "penalty", "cyan") == ""
    assert (script.state, counted(script)) == ((State.PENALTY, CYAN, True), ([0, 0], [0, 0]))


def test_penalty_that_is_given_up_may_decide_the_match() -> None:
    script = penalties()
    assert ask(script, "goal", "cyan") == ""
    for following in ("cyan", "magenta", "cyan"):
        assert not script.whistle.over
        assert ask(script, "start") == ask(script, "penalty", following) == ""
    assert (script.whistle.over, counted(script)) == (True, ([2, 2], [1, 0]))


def test_penalties_go_on_with_the_team_that_has_shot_less() -> None:
    script = penalties()
    assert ask(script, "penalty", "magenta") == ""
    for team, following in (("magenta", CYAN), ("cyan", CYAN), ("cyan", MAGENTA)):
        assert ask(script, "goal", team) == ""
        assert script.state == (State.PENALTY, following, True)
        if counted(script)[0] == [1, 1]:
            break
    assert counted(script) == ([1, 1], [1, 1])


@pytest.mark.parametrize("team", [CYAN, MAGENTA])
def test_kick_off_in_a_break_prepares_the_next_half(team: Team) -> None:
    script = in_break()
    assert ask(script, "kickoff", team.name.lower()) == ""
    assert (script.state, script.whistle.half) == ((State.KICK_OFF, team, True), 2)
    assert script.whistle.ends.cyan_side == 1.0, "the robots change ends before the half begins"
    script.tick()
    assert ask(script, "second_half") == ""
    assert (script.state, script.whistle.time_in_half_s <= 0.05) == ((State.KICK_OFF, team, True), True)
    assert ask(script, "start") == ""
    assert script.state == (State.KICK_OFF, team, False)
    ask(script, "second_half")
    assert script.state == (State.KICK_OFF, MAGENTA, True), "once begun, it begins anew as usual"


@pytest.mark.parametrize(("command", "team"), [("second_half", ""), ("kickoff", "cyan")])
def test_stop_holds_a_break_until_the_next_half(command: str, team: str) -> None:
    script = Script(half_time_s=1.0).playing()
    for name in ("stop", "half_time", "stop"):
        ask(script, name)
    script.wait(3.0)
    assert script.state == (State.HALF_TIME, 0, True)
    assert ask(script, command, team) == ""
    assert script.started().whistle.half == 2


def test_stop_before_a_break_does_not_hold_it() -> None:
    script = Script(half_time_s=1.0).playing()
    ask(script, "stop")
    ask(script, "half_time")
    script.wait(1.2)
    assert (script.state[0], script.whistle.half) == (State.KICK_OFF, 2)


def test_match_begins_with_the_kick_off_that_was_commanded() -> None:
    script = Script()
    for command, team in (("stop", ""), ("kickoff", "magenta"), ("first_half", "")):
        assert ask(script, command, team) == ""
    assert script.state == (State.KICK_OFF, MAGENTA, True)
    assert ask(script, "reset") == ""
    assert script.state == (State.KICK_OFF, CYAN, True)


def test_drawn_match_goes_on_after_its_end() -> None:
    script = Script(automatic=False)
    ask(script, "second_half")
    ask(script, "goal", "cyan")
    ask(script, "end_game")
    assert ask(script, "kickoff", "cyan").startswith("no kick-off after the end"), "it is decided"
    ask(script, "goal", "magenta")
    assert ask(script, "penalty", "cyan").startswith("no penalty after the end"), "the overtime comes first"
    assert ask(script, "kickoff", "magenta") == ""
    assert (script.state, script.whistle.half) == ((State.KICK_OFF, MAGENTA, True), 3)
    ask(script, "second_half_overtime")
    ask(script, "end_game")
    assert ask(script, "penalty", "magenta") == ""
    assert (script.state, script.whistle.half) == ((State.PENALTY, MAGENTA, True), 5)
    ask(script, "end_game")
    assert ask(script, "penalty", "magenta").startswith("no penalty after the end")


def test_decided_penalties_led_by_hand_wait_for_the_end() -> None:
    script = Script(automatic=False, penalties=1)
    ask(script, "penalties")
    ask(script, "goal", "cyan")
    ask(script, "start")
    ask(script, "penalty", "cyan")
    assert (script.state[0], counted(script)) == (State.PENALTY, ([1, 1], [1, 0]))
    assert ask(script, "end_game") == ""
    assert script.whistle.over


@pytest.mark.parametrize("at", ["", "half_time", "end_game"])
def test_penalties_decide_only_a_draw(at: str) -> None:
    """The protocol of the RefBox has no command for them: base stations would refuse the penalty."""
    script = Script(decide=True, half_time_s=60.0)
    for name, team in (("second_half_overtime", ""), (at, ""), ("goal", "magenta")):
        assert not name or ask(script, name, team) == ""
    before = script.state
    refused = "no penalties: they decide a draw, and the score is cyan 0:1 magenta; goal or subgoal corrects it"
    assert ask(script, "penalties") == refused
    assert (script.state, script.whistle.half) == (before, 4)
    assert ask(script, "subgoal", "magenta") == ask(script, "penalties") == ""
    assert (script.state, script.whistle.half) == ((State.PENALTY, CYAN, True), 5)


@pytest.mark.parametrize("command", ["start", "goal", "corner", "drop_ball", "park", "second_half", "reset"])
def test_robot_of_a_command_without_one_is_refused(command: str) -> None:
    script = Script().playing()
    before, team = script.state, "cyan" if command in ("goal", "corner") else ""
    assert carry_out(script.whistle, Sight(script.ball, robots=script.robots), command, team, "cyan2") == (
        f"'{command}' takes no robot, so not cyan2; "
        "commands with a robot are yellow_card, double_yellow, red_card, repair, substitution"
    )
    assert (script.state, script.score) == (before, (0, 0))


@pytest.mark.parametrize("command", ["start", "stop", "drop_ball", "half_time", "second_half", "penalties", "reset"])
def test_team_of_a_command_without_one_is_refused(command: str) -> None:
    script = Script().playing()
    before = script.state
    assert ask(script, command, "magenta").startswith(
        f"'{command}' takes no team, so not magenta; commands with a team are kickoff, freekick,"
    )
    assert (script.state, script.score) == (before, (0, 0))

"""Robots that do not play the ball: those sent off, and rivals that wait until the ball is free."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee import halves, restarts
from procs.referee.cards import Card
from procs.referee.reasons import Reason
from procs.referee.sight import Sight
from tests.procs.referee.script import CYAN, MAGENTA, Script


def set_piece(state: State, team: Team, x_m: float = 0.0, y_m: float = 5.0) -> Script:
    """Returns a match in which a set piece has just been started."""
    script = Script()
    script.playing()
    script.whistle.interrupt(restarts.Restart(state, team, Point(x_m, y_m)))
    return script.started()


def test_robot_with_a_red_card_scores_no_goal() -> None:
    script = Script().playing()
    script.touch("cyan2")
    script.whistle.card("cyan3", Card.RED)
    script.ball = Point(5.0, 0.0)
    script.touch("cyan3", Kind.KICK)
    assert script.whistle.state is State.PLAY
    sight = Sight(script.ball, [Event(Kind.KICK, "cyan3", "", 5.0, 0.0, 8.0)], dict(script.robots))
    assert sight.without(script.whistle.cards.sent_off).touching == {}
    script.goal(11.2, "cyan3")
    assert script.score == (0, 0)


def test_robot_with_a_red_card_takes_no_set_piece() -> None:
    script = set_piece(State.FREE_KICK, CYAN)
    script.whistle.card("cyan3", Card.RED)
    script.touch("cyan3")
    script.touch("magenta2")
    assert script.reasons[-1] == Reason.EARLY_TOUCH, "cyan has not taken it"


def test_what_a_robot_sent_off_does_is_nobodys_deed() -> None:
    events = [
        Event(Kind.COLLISION, "cyan2", "cyan3", 0.0, 0.0, 4.0),
        Event(Kind.OUT_END, "cyan3", "", 11.2, 3.0, 1.0),
        Event(Kind.TOUCH, "cyan2", "", 0.0, 0.0, 1.0),
    ]
    seen = Sight(Point(0.0, 0.0), events, {"cyan2": Point(0.0, 0.0), "cyan3": Point(1.0, 0.0)}, last_touch="cyan3")
    seen = seen.without(frozenset({"cyan3"}))
    assert [(event.kind, event.robot) for event in seen.events] == [(Kind.OUT_END, ""), (Kind.TOUCH, "cyan2")]
    assert (list(seen.robots), seen.last_touch) == (["cyan2"], "")


SET_PIECES = [State.KICK_OFF, State.CORNER_KICK, State.FREE_KICK]


@pytest.mark.parametrize("state", SET_PIECES)
def test_goal_off_a_robot_sent_off_repeats_the_set_piece(state: State) -> None:
    script = set_piece(state, CYAN)
    script.whistle.card("cyan3", Card.RED)
    script.touch("cyan3", Kind.KICK)
    script.goal(11.2, "cyan3")
    assert (script.score, script.state) == ((0, 0), (state, CYAN, True))


@pytest.mark.parametrize("state", SET_PIECES)
def test_robot_sent_off_that_moves_the_ball_repeats(state: State) -> None:
    script = set_piece(state, CYAN)
    script.whistle.card("magenta3", Card.RED)
    spot, fouls = script.ball, len(script.reasons)
    for _ in range(2):
        script.touch("magenta3")
        script.roll(spot.x_m - 0.4, spot.y_m)
        assert script.state == (state, CYAN, False), "it has not moved far"
        script.roll(spot.x_m - 0.6, spot.y_m)
        assert script.state == (state, CYAN, True)
        script.started()
        assert script.ball == spot
    assert script.reasons[fouls:] == [Reason.EARLY_TOUCH] * 2
    script.touch("magenta3")
    script.roll(spot.x_m - 0.6, spot.y_m)
    assert script.state == (State.PLAY, Team.NONE, False), "a robot must not delay the game for ever"


def test_ball_that_a_person_moves_is_played() -> None:
    script = set_piece(State.FREE_KICK, CYAN)
    script.whistle.card("magenta3", Card.RED)
    script.roll(2.0, 5.0)
    assert script.state[0] is State.PLAY


def test_dropped_ball_off_a_robot_sent_off_is_dropped_again() -> None:
    script = set_piece(State.FREE_KICK, CYAN)
    script.whistle.interrupt(restarts.dropped_ball(Point(0.0, 3.0), script.whistle.rules))
    script.started().whistle.card("magenta3", Card.RED)
    script.touch("magenta3", Kind.KICK)
    script.ball = Point(0.0, 7.2)
    script.tick(Event(Kind.OUT_SIDE, "magenta3", "", 0.0, 7.2, 2.0))
    assert (script.state, script.reasons[-1]) == ((State.DROP_BALL, Team.NONE, True), Reason.EARLY_TOUCH)


def shot_before_leaving() -> Script:
    """Returns a match in which cyan3 has shot, and is taken off the field while the ball rolls."""
    script = Script().playing()
    script.touch("cyan2")
    script.roll(3.0, 0.0)
    script.touch("cyan3", Kind.KICK)
    script.whistle.take_out("cyan3", Reason.REPAIR)
    script.tick()
    return script


def test_goal_counts_whose_shooter_has_left_since() -> None:
    script = shot_before_leaving()
    script.goal(11.2, "cyan3")
    assert (script.score, script.state) == ((1, 0), (State.KICK_OFF, MAGENTA, True))


def test_ball_goes_out_off_a_robot_that_has_left_since() -> None:
    script = shot_before_leaving()
    script.tick(Event(Kind.OUT_SIDE, "cyan3", "", 5.0, 7.2, 2.0))
    assert script.state == (State.THROW_IN, MAGENTA, True)


@pytest.mark.parametrize("same_tick", [True, False])
def test_shooter_that_touches_the_ball_after_leaving(same_tick: bool) -> None:
    script = shot_before_leaving()
    touch = Event(Kind.TOUCH, "cyan3", "", 9.0, 0.3, 2.0)
    goal = Event(Kind.GOAL, "cyan3", "", 11.2, 0.3, 2.0)
    script.tick(touch, *[goal] * same_tick)
    if not same_tick:
        script.tick(goal)
    assert (script.score, script.state) == ((0, 0), (State.DROP_BALL, Team.NONE, True))


def test_goal_off_the_keeper_after_a_touch_of_one_that_left() -> None:
    script = shot_before_leaving()
    script.tick(Event(Kind.TOUCH, "cyan3", "", 9.0, 0.3, 2.0))
    script.touch("magenta1")
    script.goal(11.2, "magenta1")
    assert script.score == (1, 0)


def test_deciding_penalty_of_a_robot_sent_off_is_a_miss() -> None:
    script = Script(penalties=1)
    script.whistle.begin_half(halves.PENALTIES)
    script.started()
    script.whistle.card("cyan3", Card.RED)
    script.touch("cyan3", Kind.KICK)
    script.goal(11.2, "cyan3")
    assert script.score == (0, 0)


def test_rivals_keep_their_distance_until_the_ball_is_free() -> None:
    script = set_piece(State.FREE_KICK, CYAN)
    script.robots["cyan2"] = Point(-0.3, 5.0)
    script.touch("cyan2")
    script.robots["magenta2"] = Point(2.0, 5.0)
    script.tick()
    assert script.reasons[-1] == Reason.TOO_NEAR


@pytest.mark.parametrize(("ball_x_m", "rival_x_m", "near"), [(1.2, -2.6, False), (2.0, 3.3, False), (1.2, 2.6, True)])
def test_distance_is_kept_to_a_ball_that_is_carried(ball_x_m: float, rival_x_m: float, near: bool) -> None:
    """A rival is too near to neither a spot that the ball has left, nor a ball that its taker brings to it."""
    script = set_piece(State.FREE_KICK, CYAN)
    before = len(script.reasons)
    script.robots["magenta2"] = Point(3.3, 5.0)
    script.touch("cyan2")
    script.carry("cyan2", ball_x_m, 5.0)
    script.robots["magenta2"] = Point(rival_x_m, 5.0)
    script.touch("cyan2")
    assert script.reasons[before:] == ([Reason.TOO_NEAR] if near else [])


@pytest.mark.parametrize("second", ["", "cyan3"])
def test_rivals_may_come_to_a_ball_that_was_played(second: str) -> None:
    script = set_piece(State.FREE_KICK, CYAN)
    script.touch("cyan2")
    if second:
        script.touch(second)
    else:
        script.roll(0.0, 5.6)
    before = list(script.reasons)
    script.robots["magenta2"] = Point(2.0, 5.0)
    script.wait(0.5)
    assert script.reasons == before


def test_the_last_miss_of_the_penalties_is_recorded() -> None:
    script = Script(penalties=1)
    script.whistle.begin_half(halves.PENALTIES)
    script.started().touch("cyan2", Kind.KICK)
    script.goal(11.2, "cyan2")
    script.started().touch("magenta2", Kind.KICK)
    script.ball = Point(-11.2, 4.0)
    script.tick(Event(Kind.OUT_END, "magenta2", "", *script.ball, 1.0))
    assert script.whistle.over
    assert (script.score, script.reasons[-1]) == ((1, 0), Reason.MISSED)
    assert [call.team for call in script.whistle.calls if call.reason is Reason.MISSED] == [MAGENTA]


def test_the_end_of_a_match_is_called_once() -> None:
    script = Script()
    script.whistle.end_match()
    called = len(script.whistle.calls)
    script.whistle.end_match()
    assert len(script.whistle.calls) == called

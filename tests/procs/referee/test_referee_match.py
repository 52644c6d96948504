"""A match as a whole: penalties, cards, halves and ends."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.cards import Card
from procs.referee.shootout import Shootout
from tests.procs.referee.script import CYAN, MAGENTA, TICK_S, Script

BESIDE = {"cyan2": Point(6.9, 0.0), "cyan3": Point(3.0, 2.0), "magenta2": Point(3.0, -2.0), "magenta3": Point(2.0, 3.0)}


def penalty() -> Script:
    script = Script().playing()
    script.robots |= BESIDE
    script.tick(Event(Kind.COLLISION, "magenta2", "cyan3", 9.5, 0.5, 3.5))
    return script.started()


def test_penalty_goal_counts_without_a_second_robot() -> None:
    script = penalty()
    script.touch("cyan2")
    script.roll(9.0, 0.0)
    script.goal(11.2, "cyan2")
    assert script.score == (1, 0)


@pytest.mark.parametrize("scores", [True, False])
def test_half_is_prolonged_for_a_penalty(scores: bool) -> None:
    script = penalty()
    script.whistle.time_in_half_s = script.whistle.rules.half_s
    script.wait(1.0)
    assert script.state == (State.PENALTY, CYAN, False)
    script.touch("cyan2")
    script.roll(9.0, 0.0)
    assert script.state == (State.PENALTY, CYAN, False), "the shot is under way"
    if scores:
        script.goal(11.2, "cyan2")
    else:
        script.touch("cyan3")
    assert (script.state[0], script.score) == (State.HALF_TIME, (int(scores), 0))


@pytest.mark.parametrize(("by", "scores"), [("", True), ("", False), ("magenta1", False)])
def test_penalty_that_was_shot_in_time_prolongs_the_half(by: str, scores: bool) -> None:
    script = penalty()
    script.touch("cyan2")
    script.roll(8.2, 0.0)
    assert script.state == (State.PLAY, Team.NONE, False)
    if by:
        script.touch(by)
    script.whistle.time_in_half_s = script.whistle.rules.half_s
    script.roll(9.0, 0.0)
    assert (script.state[0] is State.HALF_TIME) is bool(by), "a save in time ends the penalty"
    if scores:
        script.goal(11.2, "cyan2")
    else:
        script.tick(Event(Kind.OUT_END, "cyan2", "", 11.2, 2.0, 5.0))
    assert (script.state[0], script.score) == (State.HALF_TIME, (int(scores), 0))


def test_shot_of_a_lapsed_penalty_does_not_prolong_the_half() -> None:
    script = penalty()
    script.touch("cyan2")
    script.wait(10.2)
    assert script.state == (State.PLAY, Team.NONE, False)
    script.touch("cyan2", Kind.KICK)
    script.roll(8.2, 0.0)
    script.whistle.time_in_half_s = script.whistle.rules.half_s
    script.roll(9.0, 0.0)
    assert script.state == (State.HALF_TIME, Team.NONE, True)


@pytest.mark.parametrize("back", [True, False])
def test_new_keeper_of_a_penalty_has_left_no_area(back: bool) -> None:
    """A robot becomes the goalkeeper when a lower number is sent off, or comes back to the bench."""
    script = penalty()
    if back:
        script.robots |= {"magenta0": Point(0.0, 7.5)}
    else:
        script.whistle.card("magenta1", Card.RED)
    script.wait(0.5)
    assert script.state == (State.PENALTY, CYAN, False)
    script.robots["cyan3"] = Point(8.0, 1.0)
    script.wait(0.1)
    assert script.reasons[-1] == "too near to a set piece", "other breaches count"


def test_half_is_prolonged_until_a_penalty_may_be_shot() -> None:
    script = Script().playing()
    script.robots |= BESIDE
    script.tick(Event(Kind.COLLISION, "magenta2", "cyan3", 9.5, 0.5, 3.5))
    script.whistle.time_in_half_s = script.whistle.rules.half_s
    assert script.started().state == (State.PENALTY, CYAN, False)
    script.wait(9.8)
    assert script.state == (State.PENALTY, CYAN, False)
    script.wait(0.4)
    assert (script.state[0], script.score) == (State.HALF_TIME, (0, 0))


def test_penalty_that_is_not_taken_becomes_a_goal_kick() -> None:
    script = penalty()
    script.wait(9.8)
    assert script.state == (State.PENALTY, CYAN, False)
    script.wait(0.4)
    assert script.state == (State.GOAL_KICK, MAGENTA, True)


def test_penalty_that_is_touched_but_not_shot_becomes_play() -> None:
    script = penalty()
    script.touch("cyan2")
    script.wait(9.8)
    assert script.state == (State.PENALTY, CYAN, False)
    script.wait(0.4)
    assert script.state == (State.PLAY, Team.NONE, False), (
        "any robot may play: the taker may have crashed with the ball"
    )


def test_penalty_is_repeated_when_the_keeper_leaves_its_area() -> None:
    script = penalty()
    script.robots["magenta1"] = Point(9.5, 0.0)
    script.tick()
    assert script.state == (State.PENALTY, CYAN, True)
    assert script.reasons[-1] == "keeper left its area before the penalty"


def fouled_penalty(rolled_m: float) -> Script:
    """Returns a penalty of which the ball was touched and has rolled so far when magenta2 commits a foul elsewhere."""
    script = penalty()
    script.whistle.rules = script.whistle.rules.model_copy(update={"fouls_per_card": 2})
    script.touch("cyan2")
    script.roll(7.4 + rolled_m, 0.0)
    script.tick(Event(Kind.COLLISION, "magenta2", "cyan3", 3.0, 2.0, 3.5))
    assert script.state == (State.PENALTY, CYAN, False), "the shot is judged first"
    assert script.whistle.cards.warned == {"magenta2"}, "the foul counts"
    return script


@pytest.mark.parametrize(("rolled_m", "end"), [(0.2, "saved"), (1.0, "saved"), (1.0, "touched"), (0.2, "late")])
def test_fouled_penalty_is_repeated_once_its_shot_is_over(rolled_m: float, end: str) -> None:
    script = fouled_penalty(rolled_m)
    if end == "saved":
        script.roll(10.2, 0.0)
        for _ in range(12):
            script.touch("magenta1")
    elif end == "touched":
        script.touch("cyan2")
    else:
        script.wait(9.6)
        assert not script.whistle.stopped
        script.wait(0.4)
    assert script.state == (State.PENALTY, CYAN, True)
    assert script.reasons == ["collision", "collision"]


def test_fouled_penalty_may_go_in_off_the_keeper() -> None:
    script = fouled_penalty(1.0)
    script.roll(10.2, 0.0)
    script.touch("magenta1")
    script.goal(11.2, "magenta1")
    assert (script.state, script.score) == ((State.KICK_OFF, MAGENTA, True), (1, 0))
    script.robots |= {"cyan2": Point(-4.0, 2.0), "cyan3": Point(-4.0, -2.0)}
    script.started()
    script.touch("magenta2")
    script.roll(1.0, 0.0)
    assert script.state == (State.PLAY, Team.NONE, False)


def test_foul_of_the_shooters_ends_a_fouled_penalty() -> None:
    script = fouled_penalty(1.0)
    script.tick(Event(Kind.COLLISION, "cyan3", "magenta2", 3.0, 2.0, 3.5))
    assert script.state == (State.FREE_KICK, MAGENTA, True)


def test_fouled_penalty_prolongs_the_half() -> None:
    script = fouled_penalty(1.0)
    script.whistle.time_in_half_s = script.whistle.rules.half_s
    script.tick(Event(Kind.OUT_END, "cyan2", "", 11.2, 2.0, 5.0))
    assert script.started().state == (State.PENALTY, CYAN, False)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert (script.state[0], script.score) == (State.HALF_TIME, (1, 0))


def test_third_foul_brings_yellow_then_the_robot_leaves() -> None:
    script = Script(double_yellow_s=5.0).playing()
    for _ in range(6):
        script.tick(Event(Kind.COLLISION, "cyan3", "magenta2", 1.0, 1.0, 3.5))
        cards = [call.card for call in script.whistle.calls if call.card]
        script.robots["cyan3"] = Point(-4.0, -2.0)
        script.started()
        script.wait(7.1)  # until play resumes without a touch of the ball
        if cards == [Card.DOUBLE_YELLOW]:
            break
    assert cards == [Card.DOUBLE_YELLOW]
    assert script.whistle.cards.sent_off == frozenset(), "its time is over"


@pytest.mark.parametrize(
    ("card", "time_s", "out"), [(Card.DOUBLE_YELLOW, 89.0, True), (Card.DOUBLE_YELLOW, 91.0, False)]
)
def test_double_yellow_takes_a_robot_out_for_90_s(card: Card, time_s: float, out: bool) -> None:
    script = Script().playing()
    script.whistle.card("cyan3", card)
    script.wait(time_s)
    assert script.whistle.cards.sent_off == (frozenset({"cyan3"}) if out else frozenset())


def test_red_card_is_for_the_rest_of_the_match() -> None:
    script = Script().playing()
    script.whistle.card("magenta2", Card.RED)
    script.wait(300.0)
    assert script.whistle.cards.sent_off == frozenset({"magenta2"})


def test_robot_that_was_sent_off_is_not_seen() -> None:
    script = Script()
    script.robots["magenta2"] = Point(1.0, 0.0)
    script.whistle.card("magenta2", Card.RED)
    script.wait(0.6)
    assert not script.whistle.stopped, "the set piece does not wait for it"


def test_teams_change_ends_for_the_second_half() -> None:
    script = Script(half_s=10.0, half_time_s=1.0).playing()
    assert script.whistle.ends.cyan_side == -1.0
    script.wait(11.0)
    assert (script.whistle.half, script.state) == (2, (State.KICK_OFF, MAGENTA, True))
    assert script.whistle.ends.cyan_side == 1.0
    script.wait(5.0)
    assert script.whistle.stopped, "the robots are in the wrong halves"
    script.robots = {name: Point(-place.x_m, place.y_m) for name, place in script.robots.items()}
    script.robots["magenta3"] = Point(-0.5, 0.0)
    script.started()
    script.touch("magenta3")
    script.roll(1.0, 0.0)
    script.touch("magenta2")
    script.goal(11.2, "magenta2")
    assert script.score == (0, 1), "cyan defends the goal at positive x"


def test_draw_is_decided_by_overtime_and_penalties_if_wanted() -> None:
    script = Script(half_s=5.0, half_time_s=0.5, overtime_half_s=5.0, decide=True, penalties=1)
    halves = []
    for _ in range(600):
        script.tick()
        if script.whistle.half not in halves:
            halves.append(script.whistle.half)
        if script.whistle.shootout:
            break
    assert (halves, script.state) == ([1, 2, 3, 4, 5], (State.PENALTY, CYAN, True))
    script.robots |= BESIDE
    script.started()
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert script.state == (State.PENALTY, MAGENTA, True)
    script.robots |= {"cyan2": Point(-3.0, 2.0), "cyan3": Point(-3.0, -2.0), "magenta2": Point(-6.9, 0.0)}
    script.robots |= {"magenta3": Point(-2.0, 3.0)}
    script.started()
    script.wait(30.1)
    assert (script.state[0], script.score) == (State.FROZEN, (1, 0))


def test_match_ends_after_two_halves_with_a_draw() -> None:
    script = Script(half_s=5.0, half_time_s=0.5)
    script.wait(12.0)
    assert (script.whistle.half, script.state[0]) == (2, State.FROZEN)


def test_penalties_end_when_they_are_decided() -> None:
    shootout = Shootout(5)
    for scored in (True, False, True, False):
        shootout.shot(scored)
    assert not shootout.decided
    shootout.shot(True)
    shootout.shot(False)
    assert shootout.decided, "3:0 with two penalties left each"


def test_penalties_go_on_in_pairs_after_five() -> None:
    shootout = Shootout(1)
    for scored in (True, True, True):
        shootout.shot(scored)
    assert not shootout.decided
    shootout.shot(False)
    assert shootout.decided


@pytest.mark.parametrize(
    ("place", "by", "score"),
    [(11.2, "cyan2", (1, 0)), (-11.2, "cyan2", (0, 1)), (11.2, "magenta2", (1, 0)), (-11.2, "magenta2", (0, 0))],
)
def test_goal_in_the_last_tick_of_a_half_counts(place: float, by: str, score: tuple[int, int]) -> None:
    script = Script(decide=True).playing()
    whistle, ball = script.whistle, Point(4.0, 0.0)
    whistle.rules = whistle.rules.model_copy(update={"half_s": whistle.time_in_half_s + TICK_S})
    script.tick(Event(Kind.TOUCH, by, "", *ball, 5.0), Event(Kind.GOAL, by, "", place, 0.3, 5.0))
    assert (script.score, script.state) == (score, (State.HALF_TIME, Team.NONE, True))
    script.goal(place, by)
    assert script.score == score, "the ball in the goal is counted once"


@pytest.mark.parametrize("taken", [True, False])
@pytest.mark.parametrize(("x_m", "state"), [(9.5, State.PENALTY), (5.0, State.HALF_TIME)])
def test_foul_in_the_last_tick_of_a_half_counts(taken: bool, x_m: float, state: State) -> None:
    script = Script(fouls_per_card=1).started()
    if taken:
        script.touch("cyan2")
        script.roll(-1.0, 0.0)
    whistle = script.whistle
    whistle.rules = whistle.rules.model_copy(update={"half_s": whistle.time_in_half_s + TICK_S})
    script.tick(Event(Kind.COLLISION, "magenta2", "cyan3", x_m, 0.5, 3.5))
    assert script.state[0] is state
    assert whistle.cards.warned == {"magenta2"}
    script.robots |= BESIDE
    script.wait(1.0)
    assert script.state == ((State.PENALTY, CYAN, False) if state is State.PENALTY else (state, Team.NONE, True))
    script.wait(20.0)
    assert (whistle.half, script.score) == (2, (0, 0)), "the half ends with the penalty"

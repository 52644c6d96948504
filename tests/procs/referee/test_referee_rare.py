"""Cases that are rare in play: fouls as the ball leaves, penalties that defenders disturb, robots in a goal."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.reasons import Reason
from tests.procs.referee.script import CYAN, MAGENTA, Script
from tests.procs.referee.test_referee_advantage import FREE_KICK_CYAN, crowded_area
from tests.procs.referee.test_referee_cases import penalties
from tests.procs.referee.test_referee_match import penalty


@pytest.mark.parametrize("decides", [True, False])
def test_penalty_is_repeated_as_often_as_defenders_touch(decides: bool) -> None:
    script = penalties() if decides else penalty()
    for _ in range(4):
        script.touch("magenta1")
        assert (script.state, script.reasons[-1]) == ((State.PENALTY, CYAN, True), Reason.EARLY_TOUCH)
        script.started()
    assert script.whistle.cards.warned == {"magenta1"}
    script.touch("cyan2")
    script.roll(9.0, 0.0)
    script.goal(11.2, "cyan2")
    assert script.score == (1, 0)


def test_penalty_is_repeated_for_a_touch_after_another_breach() -> None:
    script = penalty()
    for _ in range(3):
        script.started().robots["magenta2"] = Point(6.0, 0.0)
        script.tick()
        assert script.reasons[-1] == Reason.TOO_NEAR
        script.robots["magenta2"] = Point(4.0, 2.0)
    assert script.state == (State.PENALTY, CYAN, False), "the third one only counts"
    script.touch("magenta2")
    assert (script.state, script.reasons[-1]) == ((State.PENALTY, CYAN, True), Reason.EARLY_TOUCH)


@pytest.mark.parametrize("place", [Point(-11.2, 0.5), Point(-11.1, 1.8)], ids=["in the goal", "on the line"])
def test_field_player_behind_its_goal_line_is_in_the_area(place: Point) -> None:
    script = Script().playing()
    script.robots["cyan3"] = place
    script.wait(3.0)
    assert script.reasons == ["goal area"]


def test_robot_beside_the_field_is_in_no_area() -> None:
    script = Script(deadlock_s=60.0).playing()
    script.robots["cyan3"] = Point(-11.3, 1.8)
    script.wait(12.0)
    assert script.reasons == []


def test_time_in_an_area_goes_on_in_the_goal() -> None:
    script = Script(deadlock_s=60.0).playing()
    places = [Point(9.0, 0.0), Point(11.2, 0.0), Point(9.0, 0.0)]
    script.whistle.rules = script.whistle.rules.model_copy(update={"grace_s": 20.0})
    for place in places:
        script.robots["cyan3"] = place
        script.wait(3.6)
    assert script.reasons == ["too long in an area"]


def test_two_that_push_at_once_bring_a_dropped_ball() -> None:
    script = Script().playing()
    script.robots |= {"cyan2": Point(1.0, 1.0), "magenta2": Point(1.5, 1.0)}
    script.robots |= {"cyan3": Point(1.5, -2.0), "magenta3": Point(1.0, -2.0)}
    forward = Point(0.5, 0.0)
    while not script.whistle.stopped:
        script.tick(cyan2=forward, magenta2=forward, cyan3=forward, magenta3=forward)
    assert (script.state, script.reasons) == ((State.DROP_BALL, Team.NONE, True), ["pushing"])


@pytest.mark.parametrize(("gaps_m", "foul"), [([0.01], False), ([0.0], True), ([0.0, 0.01], True)])
def test_robot_close_behind_a_rival_does_not_push_it(gaps_m: list[float], foul: bool) -> None:
    script = Script().playing()
    forward = Point(0.5, 0.0)
    for tick in range(60):
        script.robots |= {"cyan2": Point(1.0, 1.0), "magenta2": Point(1.5 + gaps_m[tick % len(gaps_m)], 1.0)}
        script.tick(cyan2=forward, magenta2=forward)
    assert ("pushing" in script.reasons) == foul


@pytest.mark.parametrize("kind", [Kind.OUT_SIDE, Kind.OUT_END])
def test_foul_is_punished_when_its_victims_put_the_ball_out(kind: Kind) -> None:
    script = crowded_area("cyan2")
    place = (5.0, 7.2) if kind is Kind.OUT_SIDE else (11.2, 5.0)
    script.tick(Event(kind, "cyan2", "", *place, 2.0))
    assert (script.state, script.reasons) == (FREE_KICK_CYAN, ["too many in an area"])


def test_ball_put_out_after_the_advantage_is_out() -> None:
    script = crowded_area("cyan2")
    script.robots |= {"magenta2": Point(4.0, 2.0)}
    script.wait(3.1)
    script.tick(Event(Kind.OUT_SIDE, "cyan2", "", 5.0, 7.2, 2.0))
    assert (script.state, script.reasons) == ((State.THROW_IN, MAGENTA, True), [])


CRASHES = {
    (9.5, Kind.OUT_END): (State.PENALTY, CYAN, True),
    (0.0, Kind.OUT_SIDE): (State.FREE_KICK, CYAN, True),
}


@pytest.mark.parametrize("case", CRASHES, ids=["in the area", "elsewhere"])
@pytest.mark.parametrize("last", [False, True])
def test_collision_in_the_tick_of_a_ball_out(case: tuple[float, Kind], last: bool) -> None:
    """A half that ends with this tick is prolonged only for the penalty."""
    (x_m, kind), script = case, Script().playing()
    if last:
        script.whistle.time_in_half_s = script.whistle.rules.half_s
    crash = Event(Kind.COLLISION, "magenta2", "cyan2", x_m, 0.5, 3.5)
    script.tick(Event(kind, "cyan2", "", 11.2, 7.2, 2.0), crash)
    ends = last and CRASHES[case][0] is not State.PENALTY
    assert script.state == ((State.HALF_TIME, Team.NONE, True) if ends else CRASHES[case])


@pytest.mark.parametrize("last", [False, True])
def test_goal_stands_in_the_tick_of_a_collision(last: bool) -> None:
    script = Script(fouls_per_card=1).playing()
    script.roll(2.0, 0.0)
    script.touch("cyan2")
    if last:
        script.whistle.time_in_half_s = script.whistle.rules.half_s
    crash = Event(Kind.COLLISION, "magenta2", "cyan2", 9.5, 0.5, 3.5)
    script.tick(Event(Kind.GOAL, "cyan2", "", 11.2, 0.3, 5.0), crash)
    follows = (State.HALF_TIME, Team.NONE) if last else (State.KICK_OFF, MAGENTA)
    assert (script.score, script.state) == ((1, 0), (*follows, True))
    assert script.whistle.cards.warned == {"magenta2"}, "the foul is counted"


def test_collision_as_a_penalty_goes_out_repeats_it() -> None:
    script = penalty()
    script.touch("cyan2")
    script.roll(8.2, 0.0)
    assert script.state[0] is State.PLAY
    crash = Event(Kind.COLLISION, "magenta2", "cyan2", 7.0, 0.5, 3.5)
    script.tick(Event(Kind.OUT_END, "cyan2", "", 11.2, 3.0, 5.0), crash)
    assert (script.state, script.reasons[-1]) == ((State.PENALTY, CYAN, True), "collision")

"""Fouls and conditions of goals as scripts, a rule each."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.referee.reasons import Reason
from tests.procs.referee.script import CYAN, MAGENTA, TICK_S, Script

FREE_KICK_MAGENTA = (State.FREE_KICK, MAGENTA, True)
FREE_KICK_CYAN = (State.FREE_KICK, CYAN, True)


def test_set_piece_goal_counts_only_after_a_second_robot() -> None:
    script = Script().started()
    script.ball = Point(0.1, 0.0)
    script.touch("cyan2")
    script.roll(3.0, 0.0)
    script.goal(11.2, "cyan2")
    assert (script.score, script.state) == ((0, 0), (State.GOAL_KICK, MAGENTA, True))
    assert script.reasons == ["no second robot touched the ball"]


@pytest.mark.parametrize(
    ("rival", "score"), [("bounce", (0, 0)), ("short carry", (0, 0)), ("kick", (1, 0)), ("carry", (1, 0))]
)
def test_second_robot_is_a_mate_unless_rivals_have_the_ball(rival: str, score: tuple[int, int]) -> None:
    script = Script().started()
    script.touch("cyan2")
    script.roll(3.0, 0.0)
    if "carry" in rival:
        script.carry("magenta2", 1.6 if rival == "carry" else 2.5)
    else:
        script.touch("magenta2", Kind.KICK if rival == "kick" else Kind.TOUCH)
    script.roll(script.ball.x_m - 0.6, 0.0)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert script.score == score
    assert script.reasons == ([] if any(score) else ["no second robot touched the ball"])


def test_taker_that_has_left_has_taken_the_set_piece() -> None:
    script = Script().started()
    script.touch("cyan2")
    script.whistle.take_out("cyan2", Reason.REPAIR)
    script.roll(0.3, 0.0)
    script.touch("magenta2")
    assert (script.state, script.reasons) == ((State.KICK_OFF, CYAN, False), [])


def test_set_piece_goal_counts_after_a_mate_played() -> None:
    script = Script().playing()
    script.roll(2.0, 0.0)
    script.touch("cyan3")
    script.goal(11.2, "cyan3")
    assert (script.score, script.state) == ((1, 0), (State.KICK_OFF, MAGENTA, True))


def test_own_goal_straight_from_a_set_piece_is_a_corner() -> None:
    script = Script().started()
    script.touch("cyan2")
    script.roll(-3.0, 0.0)
    script.goal(-11.2, "cyan2")
    assert (script.score, script.state) == ((0, 0), (State.CORNER_KICK, MAGENTA, True))


@pytest.mark.parametrize(("second", "score"), [("", (0, 0)), ("magenta2", (1, 0)), ("cyan3", (1, 0))])
def test_dropped_ball_goal_needs_two_robots(second: str, score: tuple[int, int]) -> None:
    script = Script(deadlock_s=1.0).playing()
    script.wait(1.1)
    assert script.state == (State.DROP_BALL, 0, True)
    script.started()
    script.ball = Point(1.0, 0.0)
    if second:
        script.touch(second)
    script.touch("cyan2")
    script.roll(3.0, 0.0)
    script.goal(11.2, "cyan2")
    assert script.score == score


@pytest.mark.parametrize(("passes", "score"), [(False, (0, 0)), (True, (1, 0))])
def test_ball_won_in_the_own_half_must_be_passed(passes: bool, score: tuple[int, int]) -> None:
    script = Script().playing()
    script.touch("magenta2")
    script.roll(-5.0, 0.0)
    script.touch("cyan2")
    if passes:
        script.roll(-3.5, 0.0)
        script.touch("cyan3")
        script.roll(1.0, 0.0)
        script.touch("cyan2")
    else:
        script.roll(1.0, 0.0)
        script.touch("cyan2")
    script.roll(2.0, 0.0)
    script.goal(11.2, "cyan2")
    reasons = [] if passes else ["no pass since the ball was won in the own half"]
    assert (script.score, script.reasons) == (score, reasons)


def test_goal_from_the_own_half_does_not_count() -> None:
    script = Script().playing()
    script.goal(11.2, "cyan3")
    assert (script.score, script.reasons[-1]) == ((0, 0), "shot from the own half")


def test_set_piece_is_play_after_half_a_metre_without_touch() -> None:
    script = Script().started()
    for x_m in (0.2, 0.4, 0.6, 0.8):  # the ball stays at the robot
        script.ball = Point(x_m, 0.0)
        script.touch("cyan2")
    states = []
    for x_m in (1.2, 1.31):
        script.roll(x_m, 0.0)
        states.append(script.state[0])
    assert states == [State.KICK_OFF, State.PLAY]


def test_taker_may_not_touch_twice() -> None:
    script = Script().started()
    script.touch("cyan2")
    script.roll(0.6, 0.0)
    script.roll(0.7, 0.0)
    script.touch("cyan2")
    assert (script.state, script.reasons) == (FREE_KICK_MAGENTA, ["double touch"])


def test_taker_may_touch_after_another_robot() -> None:
    script = Script().playing()
    script.roll(-1.5, 0.5)
    script.touch("cyan2")
    assert script.state[0] is State.PLAY


def test_robot_without_mates_may_touch_twice() -> None:
    script = Script()
    script.robots = {"cyan2": Point(-0.5, 0.0)}
    script.started()
    script.touch("cyan2")
    script.roll(0.6, 0.0)
    script.roll(1.2, 0.0)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert script.score == (1, 0)


def test_holding_the_ball_still_for_a_second_is_a_foul() -> None:
    script = Script().playing()
    script.robots["cyan3"] = Point(script.ball.x_m - 0.33, 0.0)
    ticks = 0
    while not script.whistle.stopped and ticks < 60:
        script.touch("cyan3")
        ticks += 1
    assert (script.state, script.reasons) == (FREE_KICK_MAGENTA, ["holding"])
    assert ticks * TICK_S == pytest.approx(1.05, abs=2 * TICK_S)


def test_holding_twice_with_a_short_pause_adds_up() -> None:
    script = Script().playing()
    script.robots["cyan3"] = Point(script.ball.x_m - 0.33, 0.0)
    for _ in range(14):
        script.touch("cyan3")
    script.carry("cyan3", script.ball.x_m + 1.5)
    assert script.state[0] is State.PLAY
    for _ in range(9):
        script.touch("cyan3")
    assert script.reasons == ["holding"]


@pytest.mark.parametrize(("free_s", "reasons"), [(3.0, ["holding"]), (5.0, [])])
def test_holding_is_counted_anew_after_a_long_roll(free_s: float, reasons: list[str]) -> None:
    script = Script().playing()
    for held_s in (0.8, 0.6):
        script.robots["cyan3"] = Point(script.ball.x_m - 0.33, 0.0)
        for _ in range(round(held_s / TICK_S)):
            script.touch("cyan3")
        for _ in range(round(free_s / TICK_S)):
            script.roll(script.ball.x_m + 0.02, 0.0)
    assert script.reasons == reasons


def test_pulling_the_ball_back_is_a_foul_after_30_cm() -> None:
    script = Script().playing()
    start_m = script.ball.x_m
    script.robots["cyan3"] = Point(start_m - 0.33, 0.0)
    for _ in range(40):
        script.ball = Point(script.ball.x_m - 0.05, 0.0)
        script.robots["cyan3"] = Point(script.ball.x_m - 0.33, 0.0)
        script.touch("cyan3")
        if script.whistle.stopped:
            break
    assert script.reasons == ["holding"]
    assert start_m - script.ball.x_m == pytest.approx(0.35, abs=0.11)


def test_robot_that_a_shot_hits_does_not_hold_the_ball() -> None:
    script = Script().playing()
    script.robots["cyan3"] = Point(script.ball.x_m - 1.0, 0.0)
    for _ in range(2):
        script.ball = Point(script.ball.x_m - 0.33, 0.0)
        script.touch("cyan3")
    assert script.reasons == []


def test_two_rivals_at_the_ball_do_not_hold_it() -> None:
    script = Script().playing()
    for _ in range(60):
        x_m, y_m = script.ball
        script.tick(Event(Kind.TOUCH, "cyan3", "", x_m, y_m, 0.0), Event(Kind.TOUCH, "magenta2", "", x_m, y_m, 0.0))
    assert "holding" not in script.reasons


@pytest.mark.parametrize(("way_m", "foul"), [(2.9, False), (3.2, True)])
def test_dribbling_further_than_three_metres_is_a_foul(way_m: float, foul: bool) -> None:
    script = Script().playing()
    script.carry("cyan3", script.ball.x_m + way_m)
    assert script.reasons == (["dribbling"] if foul else [])


def test_dribbling_is_counted_anew_after_the_ball_was_free() -> None:
    script = Script().playing()
    script.carry("cyan3", script.ball.x_m + 2.0)
    for _ in range(8):
        script.roll(script.ball.x_m + 0.1, 0.0)
    script.carry("cyan3", script.ball.x_m + 2.5)
    assert script.reasons == []


def test_wrong_taker_has_the_set_piece_repeated() -> None:
    script = Script().playing()
    script.ball = Point(3.0, 7.2)
    script.tick(Event(Kind.OUT_SIDE, "cyan2", "", *script.ball, 3.0))
    assert script.state == (State.THROW_IN, MAGENTA, True)
    script.started()
    script.touch("cyan3")
    assert script.state == (State.THROW_IN, MAGENTA, True)
    assert script.reasons == ["touch before the set piece was taken"]


def test_robot_that_comes_near_has_the_set_piece_repeated() -> None:
    script = Script().started()
    script.robots["magenta2"] = Point(2.8, 0.0)
    script.tick()
    assert not script.whistle.stopped, "a little nearer is no breach"
    script.robots["magenta2"] = Point(2.6, 0.0)
    script.tick()
    assert script.state == (State.KICK_OFF, CYAN, True)


def test_set_piece_is_repeated_twice_at_most() -> None:
    script = Script().started()
    stops = 0
    for _ in range(5):
        script.robots["magenta2"] = Point(2.0, 0.0)
        script.tick()
        stops += script.whistle.stopped
        script.robots["magenta2"] = Point(4.0, 2.0)
        script.started()
    assert stops == 2


def test_one_defender_may_stand_in_its_area_at_a_set_piece() -> None:
    script = Script().playing()
    script.ball = Point(9.0, 7.2)
    script.tick(Event(Kind.OUT_SIDE, "magenta2", "", *script.ball, 3.0))
    script.robots |= {"magenta2": Point(9.5, 3.2), "cyan2": Point(9.0, 6.6), "magenta3": Point(9.6, 3.3)}
    script.ball = script.whistle.spot
    script.wait(1.0)
    assert not script.whistle.stopped
    assert script.whistle.spot == Point(9.0, 6.9)


@pytest.mark.parametrize(
    ("places", "time_s", "reason"),
    [
        ({"cyan2": Point(-9.5, 2.0), "cyan3": Point(-9.5, -2.0)}, 1.5, "too many in an area"),
        ({"cyan2": Point(-10.6, 1.5)}, 1.5, "goal area"),
        ({"cyan2": Point(10.6, 1.5)}, 1.5, "goal area"),
        ({"cyan2": Point(9.5, 2.0)}, 10.5, "too long in an area"),
        ({"cyan2": Point(9.5, 2.0)}, 9.5, ""),
        ({"cyan2": Point(-9.5, 2.0), "magenta2": Point(-9.5, -2.0)}, 5.0, ""),
        ({"cyan1": Point(-9.5, 2.0), "cyan2": Point(-9.5, -2.0)}, 5.0, ""),
        ({"cyan1": Point(-10.6, 1.5)}, 15.0, ""),
        ({"cyan1": Point(10.6, 1.5)}, 1.5, "goal area"),
        ({"cyan1": Point(9.5, 2.0), "cyan2": Point(9.5, -2.0)}, 1.5, "too many in an area"),
        ({"cyan1": Point(9.5, 2.0)}, 10.5, "too long in an area"),
    ],
)
def test_areas(places: dict[str, Point], time_s: float, reason: str) -> None:
    script = Script(deadlock_s=60.0).playing()
    script.robots |= places
    script.wait(time_s)
    assert script.reasons == ([reason] if reason else [])


@pytest.mark.parametrize(("x_m", "reasons"), [(-10.6, []), (10.6, ["goal area"])])
def test_robot_that_is_alone_keeps_its_own_goal(x_m: float, reasons: list[str]) -> None:
    script = Script(deadlock_s=60.0).playing()
    for mate in ("cyan1", "cyan3"):
        del script.robots[mate]
    script.robots["cyan2"] = Point(x_m, 1.5)
    script.wait(1.5)
    assert script.reasons == reasons


@pytest.mark.parametrize(("speed_m_s", "foul"), [(0.5, True), (0.0, False)])
def test_pushing_a_rival_away_is_a_foul(speed_m_s: float, foul: bool) -> None:
    script = Script().playing()
    script.robots |= {"cyan2": Point(1.0, 1.0), "magenta2": Point(1.5, 1.0)}
    forward = Point(speed_m_s, 0.0)
    for _ in range(30):
        script.tick(cyan2=Point(0.5, 0.0), magenta2=forward)
        if script.whistle.stopped:
            break
    assert script.reasons == (["pushing"] if foul else [])
    assert not foul or script.state == FREE_KICK_MAGENTA


@pytest.mark.parametrize(("radius_m", "foul"), [(0.25, False), (0.3, True)])
def test_pushing_depends_on_the_size_of_robots(radius_m: float, foul: bool) -> None:
    script = Script(robot={"radius_m": radius_m}).playing()
    script.robots |= {"cyan2": Point(1.0, 1.0), "magenta2": Point(1.6, 1.0)}
    for _ in range(20):
        script.tick(cyan2=Point(0.5, 0.0), magenta2=Point(0.5, 0.0))
    assert ("pushing" in script.reasons) == foul


def test_two_that_push_against_each_other_may() -> None:
    script = Script().playing()
    script.robots |= {"cyan2": Point(1.0, 1.0), "magenta2": Point(1.5, 1.0)}
    for _ in range(30):
        script.tick(cyan2=Point(0.5, 0.0), magenta2=Point(-0.5, 0.0))
    assert script.reasons == []


def test_collision_in_the_own_area_brings_a_penalty() -> None:
    script = Script().playing()
    script.tick(Event(Kind.COLLISION, "magenta2", "cyan2", 9.5, 0.5, 3.5))
    assert script.state == (State.PENALTY, CYAN, True)
    assert script.whistle.spot == pytest.approx((7.4, 0.0))


def test_ball_that_no_robot_has_taken_is_no_double_touch() -> None:
    script = Script().started()
    script.roll(3.0, 0.0)
    script.touch("cyan2")
    script.roll(4.0, 0.0)
    script.touch("cyan2")
    assert (script.state[0], script.reasons) == (State.PLAY, [])


def test_dropped_ball_has_no_taker() -> None:
    script = Script(deadlock_s=1.0).playing()
    script.wait(1.1)
    script.started()
    script.touch("cyan2")
    script.roll(script.ball.x_m + 1.0, 0.0)
    script.touch("cyan2")
    assert script.reasons == ["deadlock"]


def test_taker_of_a_set_piece_may_not_dribble_further_either() -> None:
    script = Script().started()
    script.carry("cyan2", 2.9)
    assert script.state == (State.KICK_OFF, CYAN, False)
    script.carry("cyan2", 3.2)
    assert (script.state, script.reasons) == (FREE_KICK_MAGENTA, ["dribbling"])

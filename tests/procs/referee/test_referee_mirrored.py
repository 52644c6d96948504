"""Cases of the rules for either team, in either half, to the left and to the right: no call depends on these."""

import pytest

from procs.model.events import Kind
from procs.model.game_states import State
from procs.referee import restarts
from tests.procs.referee.mirror import VIEWS, Decision, Mirror, View
from tests.procs.referee.script import TICK_S

LEFT = [  # the ball leaves the field: event, last touch, place; set piece, its team and its spot
    (Kind.OUT_SIDE, "our3", (3.0, 7.2), State.THROW_IN, "theirs", (3.0, 6.9)),
    (Kind.OUT_SIDE, "our3", (-10.9, 7.2), State.THROW_IN, "theirs", (-10.25, 6.9)),
    (Kind.OUT_SIDE, "their3", (-3.0, 7.2), State.THROW_IN, "ours", (-3.0, 6.9)),
    (Kind.OUT_SIDE, "their1", (10.9, 7.2), State.THROW_IN, "ours", (10.25, 6.9)),
    (Kind.OUT_SIDE, "", (1.0, 7.2), State.DROP_BALL, "", (0.0, 3.5)),
    (Kind.OUT_END, "our3", (11.2, 3.0), State.GOAL_KICK, "theirs", (7.4, 3.5)),
    (Kind.OUT_END, "their2", (11.2, 3.0), State.CORNER_KICK, "ours", (10.8, 6.8)),
    (Kind.OUT_END, "our1", (-11.2, 3.0), State.CORNER_KICK, "theirs", (-10.8, 6.8)),
    (Kind.OUT_END, "their2", (-11.2, 6.0), State.GOAL_KICK, "ours", (-7.4, 3.5)),
    (Kind.OUT_END, "", (11.2, 6.0), State.DROP_BALL, "", (7.4, 3.5)),
]


seen_by_all = pytest.mark.parametrize("view", VIEWS, ids=lambda view: view.name)


def in_play(view: View) -> Mirror:
    match = Mirror(view)
    match.play()
    return match


def check(match: Mirror, wanted: Decision) -> None:
    found = match.decision
    assert found._replace(spot=None) == wanted._replace(spot=None)
    assert match.stopped
    if wanted.spot:
        assert found.spot == pytest.approx(wanted.spot)


def check_no_call(match: Mirror) -> None:
    assert (match.decision.state, match.decision.reason, match.stopped) == (State.PLAY, "", False)


@seen_by_all
@pytest.mark.parametrize("left", LEFT, ids=lambda left: f"{left[0].name}-{left[1] or 'nobody'}-{left[2][0]:.0f}")
def test_ball_leaves_the_field(
    view: View, left: tuple[Kind, str, tuple[float, float], State, str, tuple[float, float]]
) -> None:
    kind, robot, place, state, team, spot = left
    match = in_play(view)
    match.happen(kind, robot, *place)
    check(match, Decision(state, team, spot=spot))


@seen_by_all
def test_ball_on_the_line_is_in_play(view: View) -> None:
    match = in_play(view)
    for place in ((3.0, 6.99), (10.99, 3.0), (-10.99, 3.0)):
        match.roll(*place)
    check_no_call(match)


@seen_by_all
def test_goal_counts(view: View) -> None:
    match = in_play(view)
    match.roll(5.0)
    match.touch("our3", 6.0, 0.3)
    match.happen(Kind.GOAL, "our3", 11.2, 0.3)
    check(match, Decision(State.KICK_OFF, "theirs", spot=(0.0, 0.0), score=(1, 0)))


@seen_by_all
def test_own_goal_counts_for_the_others(view: View) -> None:
    match = in_play(view)
    match.touch("our2", -9.0, 0.3)
    match.happen(Kind.GOAL, "our2", -11.2, 0.3)
    check(match, Decision(State.KICK_OFF, "ours", spot=(0.0, 0.0), score=(0, 1)))


@seen_by_all
def test_deflected_goal_counts(view: View) -> None:
    match = in_play(view)
    match.roll(5.0)
    match.touch("our3", 6.0, 0.3)
    match.touch("their1", 10.4, 0.3)
    match.happen(Kind.GOAL, "their1", 11.2, 0.4)
    check(match, Decision(State.KICK_OFF, "theirs", spot=(0.0, 0.0), score=(1, 0)))


@seen_by_all
def test_goal_from_the_own_half(view: View) -> None:
    match = in_play(view)
    match.happen(Kind.GOAL, "our3", 11.2, 0.3)
    check(match, Decision(State.GOAL_KICK, "theirs", "shot from the own half", (7.4, 3.5)))


@seen_by_all
def test_goal_straight_from_the_kick_off(view: View) -> None:
    match = Mirror(view)
    match.touch("our2", 0.1)
    match.roll(3.0)
    match.happen(Kind.GOAL, "our2", 11.2, 0.3)
    check(match, Decision(State.GOAL_KICK, "theirs", "no second robot touched the ball", (7.4, 3.5)))


@seen_by_all
def test_own_goal_straight_from_the_kick_off(view: View) -> None:
    match = Mirror(view)
    match.touch("our2")
    match.roll(-3.0)
    match.happen(Kind.GOAL, "our2", -11.2, 0.3)
    check(match, Decision(State.CORNER_KICK, "theirs", "own goal straight from a set piece", (-10.8, 6.8)))


@seen_by_all
@pytest.mark.parametrize("passes", [True, False])
def test_ball_won_in_the_own_half(view: View, passes: bool) -> None:
    match = in_play(view)
    match.touch("their2", -4.0)
    match.touch("our2", -5.0)
    match.roll(-3.0)
    match.touch("our3" if passes else "our2", -2.0)
    match.roll(1.0)
    match.touch("our2", 2.0)
    match.happen(Kind.GOAL, "our2", 11.2, 0.3)
    if passes:
        check(match, Decision(State.KICK_OFF, "theirs", score=(1, 0)))
    else:
        check(match, Decision(State.GOAL_KICK, "theirs", "no pass since the ball was won in the own half"))


@seen_by_all
@pytest.mark.parametrize("far_m", [1.1, 0.9])
def test_pass_must_be_a_metre_long(view: View, far_m: float) -> None:
    match = in_play(view)
    match.touch("their2", -4.0)
    match.touch("our2", -0.5)
    match.roll(-0.5 + far_m / 2)
    match.touch("our3", -0.5 + far_m)
    match.roll(2.0)
    match.touch("our3", 3.0)
    match.happen(Kind.GOAL, "our3", 11.2, 0.3)
    assert match.decision.score == ((1, 0) if far_m >= 1.0 else (0, 0))


@seen_by_all
def test_holding_for_a_second(view: View) -> None:
    match = in_play(view)
    match.move("our3", match.ball.x_m - 0.33, 0.0)
    held_s = TICK_S + match.until_stopped(lambda: match.touch("our3"), 3.0)
    check(match, Decision(State.FREE_KICK, "theirs", "holding", (-1.0, 0.0)))
    assert 1.0 <= held_s <= 1.0 + 2 * TICK_S, "called in the next tick at the latest"


@seen_by_all
def test_holding_for_less(view: View) -> None:
    match = in_play(view)
    match.move("our3", match.ball.x_m - 0.33, 0.0)
    match.until_stopped(lambda: match.touch("our3"), 0.9)
    match.carry("our3", 0.5)
    check_no_call(match)


@seen_by_all
def test_pulling_back(view: View) -> None:
    match = in_play(view)
    match.move("our3", match.ball.x_m - 0.33, 0.0)
    match.touch("our3")

    def pull() -> None:
        match.move("our3", match.ball.x_m - 0.05 - 0.33, 0.0)
        match.touch("our3", match.ball.x_m - 0.05)

    pulled_m = 0.05 / TICK_S * match.until_stopped(pull, 1.0)
    check(match, Decision(State.FREE_KICK, "theirs", "holding"))
    assert 0.3 <= pulled_m < 0.3 + 2 * 0.05 + 1e-9


@seen_by_all
@pytest.mark.parametrize(("x_m", "y_m"), [(2.6, 0.0), (-4.6, 0.0), (1.6, 2.5), (-1.0, -3.6)])
def test_dribbling_for_more_than_three_metres(view: View, x_m: float, y_m: float) -> None:
    match = in_play(view)
    way_m = match.carry("our3", x_m, y_m)
    check(match, Decision(State.FREE_KICK, "theirs", "dribbling"))
    assert 3.0 < way_m <= 3.0 + 2 * 0.1 + 1e-9, "called in the next tick at the latest"


@seen_by_all
@pytest.mark.parametrize(("x_m", "y_m"), [(1.9, 0.0), (1.0, 2.1)])
def test_dribbling_for_less(view: View, x_m: float, y_m: float) -> None:
    match = in_play(view)
    match.carry("our3", x_m, y_m)
    check_no_call(match)


@seen_by_all
def test_dribbling_after_a_free_roll(view: View) -> None:
    match = in_play(view)
    match.carry("our3", 1.0)
    for step in range(1, 9):
        match.roll(1.0 + 0.1 * step)
    match.carry("our3", 4.5)
    check_no_call(match)


@seen_by_all
def test_taker_dribbles(view: View) -> None:
    match = Mirror(view)
    match.carry("our2", 4.0)
    check(match, Decision(State.FREE_KICK, "theirs", "dribbling"))


@seen_by_all
def test_double_touch_at_the_kick_off(view: View) -> None:
    match = Mirror(view)
    match.touch("our2")
    match.roll(0.6)
    match.roll(0.7)
    match.touch("our2")
    check(match, Decision(State.FREE_KICK, "theirs", "double touch", (0.7, 0.0)))


@seen_by_all
@pytest.mark.parametrize("between", ["our3", "their2"])
def test_second_touch_after_another_robot(view: View, between: str) -> None:
    match = Mirror(view)
    match.touch("our2")
    match.roll(-0.8)
    match.touch(between)
    match.roll(-1.6)
    match.touch("our2")
    check_no_call(match)


@seen_by_all
def test_double_touch_at_a_throw_in(view: View) -> None:
    match = in_play(view)
    match.happen(Kind.OUT_SIDE, "their3", 3.0, 7.2)
    match.script.started()
    match.touch("our2")
    match.roll(3.0, 6.2)
    match.touch("our2")
    check(match, Decision(State.FREE_KICK, "theirs", "double touch", (3.0, 6.2)))


@seen_by_all
def test_wrong_team_takes_the_throw_in(view: View) -> None:
    match = in_play(view)
    match.happen(Kind.OUT_SIDE, "our3", 3.0, 7.2)
    match.script.started()
    match.touch("our3")
    check(match, Decision(State.THROW_IN, "theirs", "touch before the set piece was taken", (3.0, 6.9)))


@seen_by_all
def test_rival_comes_near_at_the_kick_off(view: View) -> None:
    match = Mirror(view)
    match.move("their2", 2.6, 0.0)
    match.wait(TICK_S)
    check(match, Decision(State.KICK_OFF, "ours", "too near to a set piece", (0.0, 0.0)))


@seen_by_all
def test_kick_off_is_open_to_all_after_seven_seconds(view: View) -> None:
    match = Mirror(view)
    match.wait(6.9)
    assert match.decision.state is State.KICK_OFF
    match.wait(0.2)
    check_no_call(match)
    match.touch("their2")
    match.roll(0.6)
    match.touch("their2")
    check_no_call(match)


@seen_by_all
@pytest.mark.parametrize(
    ("robot", "place", "state", "spot"),
    [
        ("our3", (2.0, 1.0), State.FREE_KICK, (2.0, 1.0)),
        ("our3", (9.5, 0.5), State.FREE_KICK, (7.4, 0.5)),
        ("our3", (-9.5, 0.5), State.PENALTY, (-7.4, 0.0)),
        ("our3", (-4.0, 6.9), State.FREE_KICK, (-4.0, 6.5)),
    ],
)
def test_collision(view: View, robot: str, place: tuple[float, float], state: State, spot: tuple[float, float]) -> None:
    match = in_play(view)
    match.happen(Kind.COLLISION, robot, *place, other="their3", speed_m_s=3.5)
    check(match, Decision(state, "theirs", "collision", spot))


@seen_by_all
@pytest.mark.parametrize(("other", "speed_m_s"), [("their3", 2.9), ("our2", 4.0)])
def test_harmless_collision(view: View, other: str, speed_m_s: float) -> None:
    match = in_play(view)
    match.happen(Kind.COLLISION, "our3", 2.0, 1.0, other=other, speed_m_s=speed_m_s)
    check_no_call(match)


@seen_by_all
def test_pushing(view: View) -> None:
    match = in_play(view)
    match.move("our2", 1.0, 1.0)
    match.move("their2", 1.5, 1.0)
    pushed_s = match.until_stopped(lambda: match.push("our2", "their2", 0.5), 3.0)
    check(match, Decision(State.FREE_KICK, "theirs", "pushing"))
    assert 0.8 <= pushed_s <= 0.8 + 2 * TICK_S, "0.4 m at 0.5 m/s"


@seen_by_all
@pytest.mark.parametrize("end", [1.0, -1.0])
def test_two_in_a_penalty_area(view: View, end: float) -> None:
    match = in_play(view)
    for robot, y_m in (("our2", 2.0), ("our3", -2.0)):
        match.move(robot, 9.5 * end, y_m)
    match.wait(0.9)
    check_no_call(match)
    match.wait(0.3)
    assert match.decision[:3] == (State.FREE_KICK, "theirs", "too many in an area")


@seen_by_all
def test_deadlock(view: View) -> None:
    match = in_play(view)
    match.roll(6.0, 3.0)
    match.wait(7.9)
    check_no_call(match)
    match.wait(0.2)
    check(match, Decision(State.DROP_BALL, "", "deadlock", (7.4, 3.5)))


@seen_by_all
def test_penalty_counts_without_a_second_robot(view: View) -> None:
    match = in_play(view)
    match.happen(Kind.COLLISION, "their2", 9.5, 0.5, other="our2", speed_m_s=3.5)
    check(match, Decision(State.PENALTY, "ours", "collision", (7.4, 0.0)))
    match.script.started()
    match.touch("our2")
    match.roll(9.0)
    match.happen(Kind.GOAL, "our2", 11.2, 0.3)
    assert match.decision.score == (1, 0)


@seen_by_all
def test_penalty_that_is_not_taken(view: View) -> None:
    match = in_play(view)
    match.give(restarts.penalty(view.ours, match.script.whistle.rules, match.script.whistle.ends))
    match.script.started()
    match.wait(9.9)
    assert match.decision.state is State.PENALTY
    match.wait(0.2)
    check(match, Decision(State.GOAL_KICK, "theirs", "penalty not taken in time"))


@seen_by_all
@pytest.mark.parametrize(("shot", "scores"), [(False, False), (True, False), (True, True)])
def test_foul_of_the_defenders_at_a_penalty(view: View, shot: bool, scores: bool) -> None:
    match = in_play(view)
    match.give(restarts.penalty(view.ours, match.script.whistle.rules, match.script.whistle.ends))
    match.script.started()
    if shot:
        match.touch("our2")
        match.roll(9.0)
    match.happen(Kind.COLLISION, "their2", 0.0, 3.8, other="our3", speed_m_s=3.5)
    assert match.stopped is not shot
    if shot:
        match.happen(Kind.GOAL if scores else Kind.OUT_END, "our2", 11.2, 0.3 if scores else 2.0)
    if scores:
        check(match, Decision(State.KICK_OFF, "theirs", spot=(0.0, 0.0), score=(1, 0)))
    else:
        check(match, Decision(State.PENALTY, "ours", "collision", (7.4, 0.0)))

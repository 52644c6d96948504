"""Set pieces: own goals of their takers, and robots that leave the field and come back."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart
from tests.procs.referee.script import CYAN, MAGENTA, Script


@pytest.mark.parametrize(
    ("second", "score", "state", "team"),
    [("", (0, 0), State.CORNER_KICK, MAGENTA), ("magenta2", (0, 1), State.KICK_OFF, CYAN)],
)
def test_dropped_ball_own_goal_needs_two_robots(second: str, score: tuple[int, int], state: State, team: Team) -> None:
    script = Script(deadlock_s=1.0).playing()
    script.wait(1.1)
    script.started()
    assert script.state == (State.DROP_BALL, 0, False)
    script.ball = Point(-1.0, 0.0)
    if second:
        script.touch(second)
    script.touch("cyan2")
    script.roll(-3.0, 0.0)
    script.goal(-11.2, "cyan2")
    assert (script.score, script.state) == (score, (state, team, True))


def test_mates_that_come_back_make_no_touch_a_double_one() -> None:
    script = Script(repair_s=3.0).started()
    for mate in ("cyan1", "cyan3"):
        script.whistle.take_out(mate, Reason.REPAIR)
    script.touch("cyan2")
    script.roll(0.7, 0.0)
    script.touch("cyan2")
    for _ in range(80):
        script.roll(script.ball.x_m + 0.05, 0.0)
    assert not script.whistle.cards.sent_off
    assert (script.state[0], script.reasons) == (State.PLAY, [])


def test_robot_that_comes_back_breaches_no_set_piece() -> None:
    """It has waited beside the field, where the ball went out."""
    script = Script(repair_s=3.0).playing()
    script.ball = Point(3.0, 7.2)
    script.whistle.take_out("magenta3", Reason.REPAIR)
    script.robots |= {"magenta3": Point(3.0, 7.5), "cyan2": Point(3.0, 6.3)}
    script.tick(Event(Kind.OUT_SIDE, "magenta2", "", *script.ball, 3.0))
    script.started()
    assert script.whistle.cards.sent_off == {"magenta3"}
    script.wait(3.0)
    assert not script.whistle.cards.sent_off
    assert (script.state, script.reasons) == ((State.THROW_IN, CYAN, False), [])
    script.robots["magenta2"] = Point(3.5, 6.0)
    script.tick()
    assert script.reasons == ["too near to a set piece"]


@pytest.mark.parametrize(("robot", "x_m"), [("cyan3", 1.0), ("magenta3", -1.0)])
def test_halves_are_kept_until_the_kick_off_is_taken(robot: str, x_m: float) -> None:
    script = Script().started()
    script.robots[robot] = Point(0.2 * x_m, 5.0)
    script.tick()
    assert not script.whistle.stopped, "a little further is no breach"
    script.robots[robot] = Point(0.4 * x_m, 5.0)
    script.tick()
    assert script.state == (State.KICK_OFF, CYAN, True)
    assert script.reasons == ["in the other half before the kick-off"]
    script.robots[robot] = Point(-1.0 * x_m, 5.0)
    script.started()
    script.touch("cyan2")
    script.robots[robot] = Point(0.4 * x_m, 5.0)
    script.tick()
    assert len(script.reasons) == 1, "the ball has been played"


@pytest.mark.parametrize(
    ("touching", "score"), [(["cyan2"], (0, 0)), (["cyan3", "cyan2"], (1, 0)), (["magenta2"], (0, 1))]
)
def test_late_set_piece_needs_a_second_robot_of_its_team(touching: list[str], score: tuple[int, int]) -> None:
    script = Script().started()
    script.wait(7.1)
    assert script.state == (State.PLAY, Team.NONE, False)
    side = 1.0 if "cyan2" in touching else -1.0
    for robot in touching:
        script.roll(script.ball.x_m + side, 0.0)
        script.touch(robot)
    script.goal(side * 11.2, touching[-1])
    assert script.score == score
    assert script.reasons == ([] if any(score) else ["no second robot touched the ball"])


def test_ball_that_is_put_elsewhere_makes_no_set_piece_late() -> None:
    """As by hand, or in a scenario that begins with the ball before an attacker: play begins without a set piece."""
    script = Script().started()
    script.roll(3.0, 0.0)
    assert script.state == (State.PLAY, Team.NONE, False)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert (script.score, script.reasons) == ((1, 0), [])


def test_dropped_ball_needs_two_robots_however_late() -> None:
    script = Script(deadlock_s=1.0).playing()
    script.wait(1.1)
    script.started()
    script.wait(7.1)
    assert script.state == (State.PLAY, Team.NONE, False)
    script.roll(1.0, 0.0)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert script.reasons == ["deadlock", "no second robot touched the ball"]


@pytest.mark.parametrize(("roll_m", "score"), [(0.4, (0, 0)), (0.6, (1, 0))])
def test_goal_needs_a_free_roll_off_the_taker(roll_m: float, score: tuple[int, int]) -> None:
    script = Script().started()
    script.touch("cyan2")
    script.roll(roll_m, 0.0)
    script.touch("cyan3")
    script.roll(3.0, 0.0)
    script.goal(11.2, "cyan3")
    assert script.score == score
    assert script.reasons == ([] if any(score) else ["the ball of the set piece did not roll freely"])


def test_ball_carried_to_a_mate_has_not_rolled_freely() -> None:
    script = Script().started()
    script.carry("cyan2", 1.5)
    script.touch("cyan3")
    script.roll(3.0, 0.0)
    script.goal(11.2, "cyan3")
    assert (script.score, script.state) == ((0, 0), (State.GOAL_KICK, MAGENTA, True))


def test_mate_may_set_the_ball_free_for_another() -> None:
    script = Script().started()
    script.touch("cyan2")
    script.roll(0.2, 0.0)
    script.touch("cyan3")
    script.roll(1.0, 0.0)
    script.touch("cyan2")
    script.goal(11.2, "cyan2")
    assert (script.score, script.reasons) == ((1, 0), [])


@pytest.mark.parametrize("touched", [True, False])
def test_free_roll_is_not_needed_after_seven_seconds(touched: bool) -> None:
    script = Script().started()
    if touched:
        script.touch("cyan2")
    script.wait(7.1)
    assert script.state[0] is State.PLAY
    for robot in ("cyan2", "cyan3"):
        script.roll(script.ball.x_m + 0.2, 0.0)
        script.touch(robot)
    script.goal(11.2, "cyan3")
    assert (script.score, script.reasons) == ((1, 0), [])


@pytest.mark.parametrize(("kind", "score"), [(Kind.TOUCH, (0, 0)), (Kind.KICK, (1, 0))])
def test_direct_shot_off_a_defender_is_a_corner(kind: Kind, score: tuple[int, int]) -> None:
    script = Script().started()
    script.touch("cyan2", Kind.KICK)
    script.roll(10.0, 0.0)
    script.touch("magenta1", kind)
    script.goal(11.2, "magenta1")
    corner = (State.CORNER_KICK, CYAN, True)
    assert (script.score, script.state) == (score, (State.KICK_OFF, MAGENTA, True) if any(score) else corner)


def test_shot_of_a_mate_off_a_defender_counts() -> None:
    script = Script().playing()
    script.roll(3.0, 0.0)
    script.touch("cyan3")
    script.roll(10.0, 0.0)
    script.touch("magenta1")
    script.goal(11.2, "magenta1")
    assert script.score == (1, 0)


@pytest.mark.parametrize("x_m", [11.2, -11.2])
def test_ball_in_the_goal_without_a_touch_is_dropped(x_m: float) -> None:
    script = Script().started()
    script.roll(3.0, 0.0)
    assert script.state[0] is State.PLAY
    script.goal(x_m, "")
    assert (script.score, script.state) == ((0, 0), (State.DROP_BALL, Team.NONE, True))
    script = Script().started()
    script.goal(x_m, "")
    assert (script.score, script.state) == ((0, 0), (State.DROP_BALL, Team.NONE, True))


def test_ball_put_into_the_goal_by_hand_is_no_goal() -> None:
    script = Script().playing()
    script.roll(3.0, 0.0)
    script.touch("cyan2")
    script.goal(11.2, "")
    assert (script.score, script.state) == ((0, 0), (State.DROP_BALL, Team.NONE, True))


@pytest.mark.parametrize("comes", [True, False])
def test_penalty_waits_for_the_keeper_between_its_posts(comes: bool) -> None:
    """It has stood beside its post, in its goal area."""
    script = Script(positions_s=3.0)
    script.whistle.begin_half(5)
    script.tick()
    script.robots |= {"cyan2": Point(6.8, 0.0), "magenta1": Point(10.7, 1.5), "cyan3": Point(0.0, 4.0)}
    script.robots |= {"magenta2": Point(2.0, 3.0), "magenta3": Point(2.0, -3.0)}
    script.wait(2.5)
    assert script.whistle.stopped
    script.robots["magenta1"] = Point(10.7, 1.1 if comes else 1.5)
    script.tick()
    assert script.whistle.stopped is not comes
    script.wait(1.5)
    assert not script.whistle.stopped, "it has had its time"
    script.robots["magenta1"] = Point(9.0, 0.0)
    script.tick()
    assert script.reasons == ["keeper left its area before the penalty"]


@pytest.mark.parametrize(("y_m", "put_back"), [(7.1, False), (7.12, True)])
def test_ball_pushed_over_the_line_before_a_throw_in(y_m: float, put_back: bool) -> None:
    """The ball is near its spot, but wholly out of the field."""
    script = Script(stoppage_s=2.0).playing()
    script.ball = Point(3.0, 7.2)
    script.tick(Event(Kind.OUT_SIDE, "magenta2", "", *script.ball, 3.0))
    script.wait(1.0)
    placed, script.ball = script.whistle.placements, Point(3.0, y_m)
    script.wait(0.2)
    assert script.whistle.placements == placed + put_back
    assert script.started().ball == (Point(3.0, 6.9) if put_back else Point(3.0, y_m))


def beside_its_spot(off_m: float) -> Script:
    """Returns a match with a free kick whose ball the crew could not put nearer to its spot."""
    script = Script(stoppage_s=5.0).playing()
    script.whistle.interrupt(Restart(State.FREE_KICK, Team.CYAN, Point(3.0, 1.0)))
    script.placed, script.ball = script.whistle.placements, Point(3.0 + off_m, 1.0)
    return script


def test_ball_beside_its_spot_is_put_there_when_robots_have_left() -> None:
    script = beside_its_spot(0.4)
    placed, script.robots["magenta2"] = script.whistle.placements, Point(3.0, 1.0)
    script.wait(1.0)
    assert script.whistle.placements == placed
    script.robots["magenta2"] = Point(2.4, 1.0)
    script.wait(0.2)
    assert script.whistle.placements == placed + 1
    assert script.ball == (3.0, 1.0)


@pytest.mark.parametrize(("off_m", "most"), [(0.2, 0), (0.4, 2)])
def test_ball_near_its_spot_is_put_back_twice_at_most(off_m: float, most: int) -> None:
    """Something that the referee does not see may be in the way."""
    script = beside_its_spot(off_m)
    placed, place = script.whistle.placements, script.ball
    for _ in range(100):
        script.placed, script.ball = script.whistle.placements, place
        script.tick()
    assert script.whistle.placements == placed + most

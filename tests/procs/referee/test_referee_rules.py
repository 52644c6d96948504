"""The referee's rules as scripts: events from the field, and the calls that follow."""

import pytest
from pydantic import ValidationError

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.positions import misplaced
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle

TICK_S = 0.05
CENTRE = Point(0.0, 0.0)


def wait(referee: Whistle, duration_s: float, ball: Point = CENTRE) -> None:
    for _ in range(round(duration_s / TICK_S)):
        referee.step(TICK_S, Sight(ball))


def in_play(**rules: float) -> Whistle:
    referee = Whistle(Rules(**rules))
    wait(referee, referee.rules.kick_off_stoppage_s + 0.1)
    referee.step(TICK_S, Sight(Point(0.6, 0.0)))
    assert (referee.state, referee.stopped) == (State.PLAY, False)
    return referee


def event(kind: Kind, robot: str, x_m: float, y_m: float, other: str = "", speed_m_s: float = 5.0) -> Event:
    return Event(kind, robot, other, x_m, y_m, speed_m_s)


def report(referee: Whistle, *events: Event) -> None:
    referee.step(TICK_S, Sight(Point(events[-1].x_m, events[-1].y_m), events))


def test_match_begins_with_cyans_kick_off_at_the_centre_mark() -> None:
    referee = Whistle(Rules())
    assert (referee.state, referee.team, referee.stopped) == (State.KICK_OFF, Team.CYAN, True)
    assert (referee.spot, referee.placements) == (CENTRE, 1)


def test_set_piece_becomes_play_when_the_ball_has_moved() -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=2.0))
    wait(referee, 1.95)
    assert referee.stopped
    wait(referee, 0.1)
    assert (referee.state, referee.stopped) == (State.KICK_OFF, False)
    states = []
    for x_m in (0.45, 0.55):
        referee.step(TICK_S, Sight(Point(x_m, 0.0)))
        states.append((referee.state, referee.team))
    assert states == [(State.KICK_OFF, Team.CYAN), (State.PLAY, Team.NONE)]


def test_set_piece_that_no_robot_takes_becomes_play_in_time() -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, set_piece_s=3.0))
    states = []
    for duration_s in (3.9, 0.2):
        wait(referee, duration_s)
        states.append(referee.state)
    assert states == [State.KICK_OFF, State.PLAY]


@pytest.mark.parametrize(
    ("happened", "state", "team", "spot"),
    [
        (event(Kind.OUT_SIDE, "cyan2", 3.0, 7.2), State.THROW_IN, Team.MAGENTA, (3.0, 6.9)),
        (event(Kind.OUT_SIDE, "magenta4", -3.0, -7.2), State.THROW_IN, Team.CYAN, (-3.0, -6.9)),
        (event(Kind.OUT_SIDE, "magenta4", 10.9, 7.2), State.THROW_IN, Team.CYAN, (10.25, 6.9)),
        (event(Kind.OUT_END, "cyan2", 11.2, 3.0), State.GOAL_KICK, Team.MAGENTA, (7.4, 3.5)),
        (event(Kind.OUT_END, "magenta2", 11.2, -3.0), State.CORNER_KICK, Team.CYAN, (10.8, -6.8)),
        (event(Kind.OUT_END, "magenta2", -11.2, -3.0), State.GOAL_KICK, Team.CYAN, (-7.4, -3.5)),
        (event(Kind.OUT_END, "cyan1", -11.2, 3.0), State.CORNER_KICK, Team.MAGENTA, (-10.8, 6.8)),
        (event(Kind.OUT_SIDE, "", 1.0, 7.2), State.DROP_BALL, Team.NONE, (0.0, 3.5)),
        (event(Kind.OUT_END, "", 11.2, -6.0), State.DROP_BALL, Team.NONE, (7.4, -3.5)),
        (event(Kind.COLLISION, "cyan3", 2.0, 1.0, "magenta3"), State.FREE_KICK, Team.MAGENTA, (2.0, 1.0)),
        (event(Kind.COLLISION, "cyan3", -10.5, 6.9, "magenta3"), State.FREE_KICK, Team.MAGENTA, (-7.4, 6.5)),
    ],
)
def test_calls(happened: Event, state: State, team: Team, spot: tuple[float, float]) -> None:
    referee = in_play()
    report(referee, happened)
    assert (referee.state, referee.team, referee.stopped) == (state, team, True)
    assert referee.spot == pytest.approx(spot)
    assert referee.placements == 2


@pytest.mark.parametrize(
    "harmless",
    [
        event(Kind.COLLISION, "cyan3", 2.0, 1.0, "magenta3", speed_m_s=1.0),
        event(Kind.COLLISION, "cyan3", 2.0, 1.0, "cyan4"),
        event(Kind.TOUCH, "cyan3", 2.0, 1.0),
        event(Kind.KICK, "cyan3", 2.0, 1.0),
    ],
)
def test_play_goes_on_after(harmless: Event) -> None:
    referee = in_play()
    report(referee, harmless)
    assert referee.state is State.PLAY


@pytest.mark.parametrize(
    ("touched_at_m", "by", "goal_at_m", "score", "state", "team"),
    [
        (6.0, "cyan2", 11.2, (1, 0), State.KICK_OFF, Team.MAGENTA),
        (-6.0, "magenta2", -11.2, (0, 1), State.KICK_OFF, Team.CYAN),
        (-0.5, "cyan2", 11.2, (0, 0), State.GOAL_KICK, Team.MAGENTA),  # from the own half
        (-9.0, "cyan2", -11.2, (0, 1), State.KICK_OFF, Team.CYAN),  # own goal
        (2.0, "cyan2", -11.2, (0, 1), State.KICK_OFF, Team.CYAN),  # own goal from afar
    ],
)
def test_goals(
    touched_at_m: float, by: str, goal_at_m: float, score: tuple[int, int], state: State, team: Team
) -> None:
    referee = in_play()
    report(referee, event(Kind.TOUCH, by, touched_at_m, 0.0))
    report(referee, event(Kind.GOAL, by, goal_at_m, 0.2))
    assert (referee.score[Team.CYAN], referee.score[Team.MAGENTA]) == score
    assert (referee.state, referee.team) == (state, team)


def test_goal_counts_once_and_not_while_the_game_is_stopped() -> None:
    referee = in_play()
    report(referee, event(Kind.TOUCH, "cyan2", 6.0, 0.0), event(Kind.GOAL, "cyan2", 11.2, 0.0))
    report(referee, event(Kind.GOAL, "cyan2", 11.3, 0.0))
    assert referee.score[Team.CYAN] == 1


def test_stuck_ball_is_dropped_at_the_nearest_mark() -> None:
    referee = in_play(deadlock_s=5.0)
    wait(referee, 1.0, Point(6.0, -3.0))
    wait(referee, 3.9, Point(6.2, -3.0))
    assert referee.state is State.PLAY
    wait(referee, 0.5, Point(6.2, -3.0))
    assert (referee.state, referee.team) == (State.DROP_BALL, Team.NONE)
    assert referee.spot == pytest.approx((7.4, -3.5))


def test_ball_pushed_away_during_a_stoppage_is_put_back() -> None:
    referee = in_play()
    report(referee, event(Kind.OUT_SIDE, "cyan2", 3.0, 7.2))
    wait(referee, 0.6, Point(3.0, 6.9))
    assert referee.placements == 2
    wait(referee, 0.1, Point(3.0, 5.9))
    assert referee.placements == 3
    assert referee.spot == pytest.approx((3.0, 6.9))


def test_magenta_kicks_off_second_half_and_then_the_match_ends() -> None:
    referee = in_play(half_s=20.0, half_time_s=2.0)
    wait(referee, 15.0)
    assert (referee.state, referee.half) == (State.HALF_TIME, 1)
    wait(referee, 2.0)
    assert (referee.state, referee.team, referee.half) == (State.KICK_OFF, Team.MAGENTA, 2)
    assert referee.placements >= 2
    wait(referee, 20.0)
    assert referee.over
    report(referee, event(Kind.GOAL, "cyan2", 11.2, 0.0))
    assert (referee.state, referee.score[Team.CYAN]) == (State.FROZEN, 0)


def test_a_coin_gives_magenta_the_first_kick_off() -> None:
    rules = Rules(first_kick_off="magenta", half_s=20.0, half_time_s=2.0, decide=True, overtime_half_s=20.0)
    referee = Whistle(rules)
    began = [referee.team]
    for _ in range(4):
        wait(referee, 22.1)
        began.append(referee.team)
    assert (referee.half, began) == (5, [Team.MAGENTA, Team.CYAN, Team.MAGENTA, Team.CYAN, Team.MAGENTA])
    referee.begin_match()
    assert (referee.half, referee.state, referee.team) == (1, State.KICK_OFF, Team.MAGENTA)


def test_set_piece_waits_for_robots_that_are_misplaced() -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, positions_s=4.0))
    away = {"cyan1": Point(-5.0, 0.0), "cyan2": Point(-0.7, 0.0), "magenta1": Point(4.0, 0.0)}
    for _ in range(40):
        referee.step(TICK_S, Sight(CENTRE, robots=away | {"magenta2": Point(2.5, 0.0)}))
    assert referee.stopped, "magenta2 is nearer than 3 m"
    referee.step(TICK_S, Sight(CENTRE, robots=away))
    assert not referee.stopped


def test_distances_are_those_to_a_ball_beside_the_spot() -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, positions_s=2.0))
    beside, near = Point(0.5, 0.0), {"cyan2": Point(-0.5, 0.0), "magenta2": Point(3.2, 0.0)}
    for _ in range(40):
        referee.step(TICK_S, Sight(beside, robots=near))
    assert referee.stopped, "2.7 m from the ball, 3.2 m from the spot"
    referee.step(TICK_S, Sight(beside, robots=near | {"magenta2": Point(3.6, 0.0)}))
    assert not referee.stopped


def test_set_piece_does_not_wait_forever() -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, positions_s=2.0))
    stopped = []
    for _ in range(70):
        referee.step(TICK_S, Sight(CENTRE, robots={"magenta2": Point(2.5, 0.0)}))
        stopped.append(referee.stopped)
    assert stopped.index(False) == pytest.approx(60, abs=1)


@pytest.mark.parametrize(("rolls_s", "started_s"), [(0.0, 1.0), (1.5, 1.5), (9.0, 3.0)])
def test_set_piece_waits_for_a_ball_that_rolls(rolls_s: float, started_s: float) -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, positions_s=2.0))
    ticks = 0
    while referee.stopped:
        ticks += 1
        to_and_fro_m = 0.02 * (ticks % 2) if ticks * TICK_S < rolls_s else 0.0
        referee.step(TICK_S, Sight(Point(0.0, to_and_fro_m)))
    assert ticks * TICK_S == pytest.approx(started_s, abs=2 * TICK_S)


@pytest.mark.parametrize(("pushes", "started_s"), [(1, 4.5), (2, 6.5), (3, 6.5), (9, 6.5)])
def test_robots_get_new_time_when_the_ball_was_put_back(pushes: int, started_s: float) -> None:
    referee = Whistle(Rules(kick_off_stoppage_s=1.0, positions_s=2.0))
    pushed_s = [2.5, 4.5, *(5.1 + 0.55 * more for more in range(7))][:pushes]
    near = {"magenta2": Point(2.5, 0.0)}
    time_s = 0.0
    while referee.stopped:
        time_s += TICK_S
        away = any(time_s - TICK_S < at_s <= time_s for at_s in pushed_s)
        referee.step(TICK_S, Sight(Point(0.9, 0.0) if away else CENTRE, robots=near))
    assert time_s == pytest.approx(started_s, abs=2 * TICK_S)


@pytest.mark.parametrize(
    ("state", "team", "robot", "place", "allowed"),
    [
        (State.FREE_KICK, Team.CYAN, "cyan2", (1.9, 0.0), False),
        (State.FREE_KICK, Team.CYAN, "cyan2", (2.1, 0.0), True),
        (State.FREE_KICK, Team.CYAN, "magenta2", (2.9, 0.0), False),
        (State.FREE_KICK, Team.CYAN, "magenta2", (3.1, 0.0), True),
        (State.DROP_BALL, Team.NONE, "cyan2", (0.9, 0.0), False),
        (State.DROP_BALL, Team.NONE, "magenta2", (1.1, 0.0), True),
        (State.KICK_OFF, Team.CYAN, "cyan2", (0.5, 4.0), False),
        (State.KICK_OFF, Team.CYAN, "magenta2", (-0.5, 4.0), False),
        (State.KICK_OFF, Team.CYAN, "magenta2", (0.5, 4.0), True),
        (State.THROW_IN, Team.CYAN, "magenta2", (-0.5, 4.0), True),
    ],
)
def test_positions_of_robots_at_a_set_piece(
    state: State, team: Team, robot: str, place: tuple[float, float], allowed: bool
) -> None:
    robots = {"cyan1": Point(-0.5 - 1.0 * (team is Team.NONE), 0.0), robot: Point(*place)}
    assert misplaced(Restart(state, team, CENTRE), robots) == ([] if allowed else [robot])


@pytest.mark.parametrize("length", ["half_s", "overtime_half_s"])
def test_half_lasts_for_some_ticks(length: str) -> None:
    with pytest.raises(ValidationError, match=r"greater than or equal to 0\.1"):
        Rules.model_validate({length: 1e-300})
    assert getattr(Rules.model_validate({length: 0.1}), length) == 0.1

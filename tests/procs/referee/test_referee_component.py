"""Messages of the referee on the bench."""

from typing import Any

from fwk.testing import Bench
from lcmtypes.soccer import game_state_t, match_event_t
from procs.referee.referee import Referee


def make(kind: int, robot: str = "cyan2", x_m: float = 6.0) -> match_event_t:
    made = match_event_t()
    made.kind, made.robot, made.x_m, made.speed_m_s = kind, robot, x_m, 5.0
    return made


def state(bench: Bench) -> Any:
    return bench.port("game_state").sent[-1]


def playing() -> Bench:
    bench = Bench(Referee, "world/referee", kick_off_stoppage_s=0.5)
    for _ in range(12):
        bench.port("match_events").put()
        bench.iterate()
    bench.port("match_events").put(ball_x_m=3.0)
    bench.iterate()
    assert state(bench).state == game_state_t.PLAY
    return bench


def test_first_tick_kicks_off_and_places_the_ball() -> None:
    bench = Bench(Referee, "world/referee")
    bench.iterate()
    assert (state(bench).state, state(bench).stopped) == (game_state_t.KICK_OFF, True)
    placed = bench.port("ball_placement").sent
    assert [(each.placement_id, each.x_m, each.y_m) for each in placed] == [(1, 0.0, 0.0)]
    bench.iterate(5)
    assert len(bench.port("ball_placement").sent) == 1
    assert len(bench.port("game_state").sent) == 6


def test_goal_is_counted_and_the_ball_goes_to_the_centre() -> None:
    bench = playing()
    bench.port("match_events").put(
        ball_x_m=11.2, events=[make(match_event_t.TOUCH), make(match_event_t.GOAL, x_m=11.2)]
    )
    bench.iterate()
    now = state(bench)
    assert (now.score_cyan, now.score_magenta, now.state, now.state_team) == (
        1,
        0,
        game_state_t.KICK_OFF,
        game_state_t.TEAM_MAGENTA,
    )
    assert bench.port("ball_placement").sent[-1].placement_id == 2
    assert bench.logged[-1].text.startswith("kick off for magenta, cyan 1:0 magenta")


def test_events_of_several_ticks_all_count() -> None:
    bench = playing()
    bench.port("match_events").put(ball_x_m=6.0, events=[make(match_event_t.TOUCH)])
    bench.port("match_events").put(ball_x_m=11.2, events=[make(match_event_t.GOAL, x_m=11.2)])
    bench.port("match_events").put(ball_x_m=11.3)
    bench.iterate()
    assert state(bench).score_cyan == 1


def test_unknown_kinds_of_events_are_ignored() -> None:
    bench = playing()
    bench.port("match_events").put(ball_x_m=3.0, events=[make(99)])
    bench.iterate()
    assert state(bench).state == game_state_t.PLAY

"""Measures of the play: restarts, passes, captures, shots and results of game pieces."""

import pytest

from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import game_state_t, match_event_t, role_t, skill_status_t
from procs.evaluation.conduct import conducted
from procs.evaluation.piece import Piece
from procs.evaluation.possession import possession
from tests.procs.evaluation.pieces import FIRST, event, piece, playing, robot


@pytest.mark.parametrize(
    ("others", "violated"),
    [([(3.1, 0.0), (-2.1, 0.0)], False), ([(2.8, 0.0)], True), ([(3.1, 0.0), (-1.8, 0.0)], True)],
)
def test_distances_count_when_a_set_piece_is_released(others: list[tuple[float, float]], violated: bool) -> None:
    names = ("magenta1", "cyan2")
    robots = [robot("cyan1", -0.5, 0.0), *(robot(name, *at) for name, at in zip(names, others, strict=False))]
    made = piece(robots, ticks=2, vx_m_s=0.0)
    for tick, stopped in ((FIRST, True), (FIRST + 1, False)):
        game = made.game[tick] = game_state_t()
        game.state, game.state_team, game.stopped = game_state_t.FREE_KICK, game_state_t.TEAM_CYAN, stopped
    assert conducted(made)["distance violated at restarts"].tolist() == [violated]


@pytest.mark.parametrize(("ball_m", "violated"), [(0.0, True), (0.4, False)])
def test_distances_count_until_the_ball_moves(ball_m: float, violated: bool) -> None:
    """The rival comes near half a second after the release."""
    made = piece([robot("cyan1", -0.5, 0.0), robot("magenta1", 3.1, 0.0)], ticks=20, vx_m_s=0.0)
    for tick in made.truth:
        game = made.game[tick] = game_state_t()
        game.state, game.state_team, game.stopped = game_state_t.FREE_KICK, game_state_t.TEAM_CYAN, tick == FIRST
        if tick >= FIRST + 10:
            made.truth[tick].ball_x_m = ball_m
            made.truth[tick].robots = [robot("cyan1", -0.5, 0.0), robot("magenta1", 2.9, 0.0)]
    assert conducted(made)["distance violated at restarts"].tolist() == [violated]


@pytest.mark.parametrize(("at_release_m", "violated"), [(1.2, False), (0.8, True)])
def test_robots_may_go_to_a_ball_once_it_is_dropped(at_release_m: float, violated: bool) -> None:
    made = piece([robot("cyan1", at_release_m, 0.0)], ticks=20, vx_m_s=0.0)
    for tick in made.truth:
        game = made.game[tick] = game_state_t()
        game.state, game.stopped = game_state_t.DROP_BALL, tick == FIRST
        if tick >= FIRST + 10:
            made.truth[tick].robots = [robot("cyan1", 0.6, 0.0)]
    assert conducted(made)["distance violated at restarts"].tolist() == [violated]


@pytest.mark.parametrize(("sent_off", "violated"), [([], True), (["magenta2"], False)])
def test_robots_that_were_sent_off_violate_nothing(sent_off: list[str], violated: bool) -> None:
    made = piece([robot("cyan1", -0.5, 0.0), robot("magenta2", -4.0, 7.5)], ticks=2, vx_m_s=0.0)
    for tick, stopped in ((FIRST, True), (FIRST + 1, False)):
        game = made.game[tick] = game_state_t()
        game.state, game.state_team, game.stopped = game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, stopped
        game.sent_off = sent_off
    assert conducted(made)["half violated at kick-offs"].tolist() == [violated]


@pytest.mark.parametrize(
    ("kicker", "after_s", "taken"),
    [("cyan1", 6.9, [True]), ("cyan1", 7.2, [False]), ("magenta1", 1.0, [False])],
)
def test_restart_is_taken_once_its_team_kicks(kicker: str, after_s: float, taken: list[bool]) -> None:
    made = piece([robot("cyan1", 0.0, 0.0), robot("magenta1", 3.0, 1.0)], ticks=200, vx_m_s=0.0)
    for tick in made.truth:
        game = made.game[tick] = game_state_t()
        game.state, game.state_team, game.stopped = game_state_t.THROW_IN, game_state_t.TEAM_CYAN, tick < FIRST + 10
    made.events = {FIRST + 10 + round(after_s / 0.05): [event(match_event_t.KICK, kicker, 3.0)]}
    assert conducted(made)["restarts taken within 7 s"].tolist() == taken


@pytest.mark.parametrize("until", [100, 200])
def test_restart_that_is_cut_short_does_not_count(until: int) -> None:
    """Either the piece ends, or the referee stops the game again."""
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=until, vx_m_s=0.0)
    for tick in made.truth:
        game = made.game[tick] = game_state_t()
        game.state_team, game.stopped = game_state_t.TEAM_CYAN, not 10 <= tick - FIRST < 100
    assert conducted(made)["restarts taken within 7 s"].tolist() == []


def test_restart_near_the_end_does_not_count_though_taken() -> None:
    """Without this the rate of pieces would rise with the number of restarts at their ends."""
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=100, vx_m_s=0.0)
    for tick in made.truth:
        game = made.game[tick] = game_state_t()
        game.state_team, game.stopped = game_state_t.TEAM_CYAN, tick < FIRST + 10
    made.events = {FIRST + 20: [event(match_event_t.KICK, "cyan1", 3.0)]}
    assert conducted(made)["restarts taken within 7 s"].tolist() == []


def passed(toucher: str, ticks: int = 200, ball_m_s: float = 0.0) -> Piece:
    """Returns a piece with a pass from cyan1, which another robot then touches and keeps if it is cyan2."""
    made = piece([robot("cyan1", 0.0, 0.0), robot("cyan2", 3.0, 0.0), robot("magenta1", 3.0, 1.0)], ticks, ball_m_s)
    made.game = {tick: playing() for tick in made.truth}
    status, holding = skill_status_t(), kicker_state_t()
    status.skill, holding.ball_held = "pass", True
    made.by_robot |= {
        "skill_status": {"cyan1": {FIRST: status}},
        "kicker_state": {"cyan2": dict.fromkeys(made.truth, holding), "magenta1": {}},
    }
    made.events = {FIRST + 1: [event(match_event_t.KICK, "cyan1", 4.0)]}
    touching = [event(match_event_t.TOUCH, toucher)] if toucher else []
    made.events |= dict.fromkeys(range(FIRST + 10, FIRST + 20), touching)
    return made


@pytest.mark.parametrize(("toucher", "controlled"), [("cyan2", True), ("magenta1", False), ("", False)])
def test_pass_is_controlled_once_a_mate_holds_the_ball(toucher: str, controlled: bool) -> None:
    assert conducted(passed(toucher))["passes controlled by the receiver"].tolist() == [controlled]


@pytest.mark.parametrize("every", [2, 5])
def test_pass_counts_though_components_miss_ticks(every: int) -> None:
    """A component with `every` says nothing in the ticks between its iterations."""
    made = passed("cyan2")
    told = made.by_robot["kicker_state"]["cyan2"]
    made.by_robot["kicker_state"]["cyan2"] = {tick: said for tick, said in told.items() if tick % every == 0}
    made.by_robot["skill_status"]["cyan1"] = {FIRST + 1 - every: made.by_robot["skill_status"]["cyan1"][FIRST]}
    assert conducted(made)["passes controlled by the receiver"].tolist() == [True]


def test_pass_whose_end_the_piece_does_not_show_does_not_count() -> None:
    assert conducted(passed("", ticks=40))["passes controlled by the receiver"].tolist() == []


def test_pass_that_a_foul_interrupts_does_not_count() -> None:
    made = passed("", ball_m_s=1.0)
    for tick in list(made.truth)[30:]:
        made.game[tick].stopped = True
    assert conducted(made)["passes controlled by the receiver"].tolist() == []


@pytest.mark.parametrize("kind", [match_event_t.OUT_SIDE, match_event_t.OUT_END, match_event_t.GOAL])
@pytest.mark.parametrize("ahead_m", [0.0, 0.08, 0.16, 0.24])
def test_pass_out_of_the_field_counts_wherever_a_tick_ends(kind: int, ahead_m: float) -> None:
    """At 5 m/s the ball may be inside the field one tick, and out of it by 0.1 to 0.35 m in the next."""
    made = passed("", ball_m_s=5.0)
    for truth in made.truth.values():
        truth.ball_x_m += ahead_m
    out = min(tick for tick, truth in made.truth.items() if truth.ball_x_m > 11.11)
    made.events[out] = [event(kind, "cyan1")]
    made.game |= {tick: _stopped() for tick in made.truth if tick >= out}
    assert conducted(made)["passes controlled by the receiver"].tolist() == [False]


def test_pass_that_goes_out_in_the_tick_of_its_kick_counts() -> None:
    made = passed("")
    made.events = {FIRST + 1: [event(match_event_t.OUT_SIDE, "cyan1"), *made.events[FIRST + 1]]}
    made.game |= {tick: _stopped() for tick in made.truth if tick > FIRST}
    assert conducted(made)["passes controlled by the receiver"].tolist() == [False]


def test_captures_that_bounce_and_a_free_ball_are_counted() -> None:
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=60)
    made.game = dict.fromkeys(made.truth, playing())
    made.events = {FIRST + 10: [event(match_event_t.TOUCH, "cyan1")]}
    made.events |= {tick: [event(match_event_t.TOUCH, "cyan1")] for tick in range(FIRST + 30, FIRST + 60)}
    found = possession(made)
    assert found["captures that bounce"].tolist() == [True, False]
    assert found["ball free"].mean() == pytest.approx(23 / 60, abs=0.04)


@pytest.mark.parametrize(("whistle_s", "found"), [(0.0, []), (0.55, []), (0.65, [True])])
def test_capture_that_a_whistle_follows_is_left_out(whistle_s: float, found: list[bool]) -> None:
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=200)
    made.game = dict.fromkeys(made.truth, playing())
    made.events = {FIRST + 10: [event(match_event_t.TOUCH, "cyan1")]}
    stopped = FIRST + 11 + round(whistle_s / 0.05)
    made.game |= dict.fromkeys(range(stopped, stopped + 40), _stopped())
    assert possession(made)["captures that bounce"].tolist() == found


@pytest.mark.parametrize(("skill", "shots"), [("shoot", 1), ("lob", 1), ("pass", 0)])
def test_shots_are_fast_kicks_of_the_skills_that_shoot(skill: str, shots: int) -> None:
    made = piece([robot("cyan1", 0.0, 0.0)])
    status = skill_status_t()
    status.skill = skill
    made.events = {FIRST + at: [event(match_event_t.KICK, "cyan1", speed)] for at, speed in ((5, 10.0), (20, 3.0))}
    for every in (1, 3):
        made.by_robot["skill_status"] = {"cyan1": dict.fromkeys(list(made.truth)[::every], status)}
        assert possession(made)["shots"][0, 0] == shots
    made.by_robot["skill_status"] = {"cyan1": {FIRST - 10: status}}
    assert possession(made)["shots"][0, 0] == 0, "it has long been silent"


@pytest.mark.parametrize(("cyan", "magenta", "won", "lost"), [(2, 1, 1.0, 0.0), (1, 1, 0.0, 0.0), (0, 1, 0.0, 1.0)])
def test_matches_are_won_and_lost_by_goals(cyan: int, magenta: int, won: float, lost: float) -> None:
    made = piece([robot("cyan1", 0.0, 0.0)])
    game = playing()
    game.score_cyan, game.score_magenta = cyan, magenta
    made.game = dict.fromkeys(made.truth, game)
    found = possession(made)
    assert (found["won by cyan"].tolist(), found["lost by cyan"].tolist()) == ([won], [lost])


def _stopped() -> game_state_t:
    game = game_state_t()
    game.state, game.stopped = game_state_t.THROW_IN, True
    return game


@pytest.mark.parametrize(("cyan", "magenta"), [(0, 0), (2, 1)])
def test_goals_are_those_of_both_teams_together(cyan: int, magenta: int) -> None:
    """A ball in the goal that the referee does not count is none."""
    made = piece([robot("cyan1", 0.0, 0.0)], ticks=40)
    for tick in made.truth:
        made.game[tick] = playing()
    made.game[max(made.game)].score_cyan, made.game[max(made.game)].score_magenta = cyan, magenta
    made.events = {FIRST: [event(match_event_t.GOAL, "cyan1")]}
    found = conducted(made) | possession(made)
    assert found["goals"].tolist() == [[cyan + magenta, made.minutes]]
    assert found["goals"][0, 0] == found["goals of cyan"][0, 0] + found["goals of magenta"][0, 0]


def test_role_changes_count_in_play_and_without_goalkeepers() -> None:
    made = piece([robot("cyan2", 0.0, 0.0)], ticks=6, vx_m_s=0.0)
    told = {
        "cyan1": ["goalkeeper"] * 6,
        "cyan2": ["attacker", "defender", "defender", "attacker", "attacker", "passer"],
    }
    roles = made.by_robot["role"] = {}
    for name, each in told.items():
        roles[name] = {FIRST + number: role_t(role=role) for number, role in enumerate(each)}
    for tick in made.truth:
        made.game[tick] = playing()
    made.game[FIRST + 3].stopped = True
    changes, minutes = conducted(made)["role changes of a field player"][0]
    assert changes == 2
    assert minutes == pytest.approx(4 * 0.05 / 60)


def test_role_changes_count_though_agents_miss_ticks() -> None:
    made = piece([robot("cyan2", 0.0, 0.0)], ticks=6, vx_m_s=0.0)
    told = {FIRST: "attacker", FIRST + 2: "defender", FIRST + 4: "defender"}
    made.by_robot["role"] = {"cyan2": {tick: role_t(role=role) for tick, role in told.items()}}
    made.game = {tick: playing() for tick in made.truth}
    changes, minutes = conducted(made)["role changes of a field player"][0]
    assert (changes, minutes) == (1, pytest.approx(5 * 0.05 / 60))

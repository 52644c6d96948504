"""Teams without a radio: robots that see their mates share the work without a word."""

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import ball_estimate_t, game_state_t, robot_estimate_t, world_model_t
from procs.behaviour.agent import Agent
from procs.behaviour.company import Company, job_among_silent, rank_of
from procs.behaviour.game import Game, Whose
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, PASSER, SUPPORTER, assign
from procs.behaviour.tactics import Tactics
from procs.behaviour.view import Robot, View
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.robot import ABSENT, PLAYERS, Player
from procs.world_model.world_model import WorldModel
from tests.procs.behaviour.behaviour_parts import FIELD, ball, job, robot, view

BALL = ball(2.0, 1.0)


def silent(x_m: float, y_m: float, speed_m_s: float = 0.0) -> Robot:
    return Robot("", Point(x_m, y_m), velocity_m_s=Point(speed_m_s, 0.0))


def among(own: Robot, *mates: Robot) -> View:
    return view(own, BALL)._replace(silent_mates=mates)


def test_robot_that_saw_a_mate_drive_is_in_company_for_a_while() -> None:
    company, own = Company(), robot("cyan2", 0.0, 0.0)
    assert not company.watch(among(own), 1.0)
    assert not company.watch(among(own, silent(1.0, 1.0)), 1.0), "it may be out of order"
    assert company.watch(among(own, silent(1.0, 1.0, 1.0)), 1.0)
    found = [company.watch(among(own), 1.0) for _ in range(12)]
    assert found[8]
    assert not found[-1]


def test_robot_that_hears_mates_follows_the_roles_of_the_team() -> None:
    company, own, mate = Company(), robot("cyan2", 0.0, 0.0), robot("cyan3", 1.0, 1.0)
    assert not company.watch(view(own, BALL, (mate,)), 1.0)
    assert company.watch(view(own, BALL, (mate._replace(role=ABSENT),)), 1.0), "the last one that played may be silent"


def test_mate_that_was_heard_and_sent_off_is_no_company() -> None:
    company, own = Company(), robot("cyan2", 0.0, 0.0)
    company.watch(view(own, BALL, (robot("cyan1", 1.0, 1.0),)), 1.0)
    assert not company.watch(among(own), 1.0, ("cyan1",))
    assert company.watch(among(own, silent(1.0, 1.0, 1.0)), 1.0, ("cyan1",)), "another one drives"
    assert company.watch(among(own), 1.0, ("cyan1",))


@pytest.mark.parametrize(("name", "rank"), [("cyan1", 0), ("cyan5", 5), ("magenta2", 1), ("zoe", 1)])
def test_rank_counts_the_lower_numbers_of_the_team(name: str, rank: int) -> None:
    assert rank_of(name, {**PLAYERS, "zoe": Player(team="cyan", number=2)}) == rank


def test_silent_team_has_a_keeper_one_attacker_and_places() -> None:
    team = [robot(f"cyan{number}", -9.0 + 2 * number, -3.0) for number in range(1, 6)]
    jobs = []
    for rank, own in enumerate(team):
        mates = [silent(*mate.place) for mate in team if mate is not own]
        jobs.append(job_among_silent(among(own, *mates), rank, FIELD))
    assert [found.role for found in jobs] == [GOALKEEPER, SUPPORTER, DEFENDER, DEFENDER, ATTACKER]
    assert len({found.place for found in jobs}) == len(jobs)


def test_ball_near_a_silent_keeper_is_not_left_to_it() -> None:
    own, keeper = robot("cyan3", -6.0, 0.0), silent(-10.0, 0.0)
    seen = among(own, keeper)._replace(ball=ball(-8.4, 1.0))
    assert job_among_silent(seen, 2, FIELD).role == ATTACKER
    passer = seen._replace(own=own._replace(role=PASSER))
    assert job_among_silent(passer, 2, FIELD).role != ATTACKER


def test_taker_among_silent_mates_does_not_dribble() -> None:
    tactics, game = Tactics(FIELD), Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(2.0, 1.0))
    seen = among(robot("cyan2", 1.67, 1.0), silent(-4.0, 0.0))
    orders = [tactics.decide(seen, game, job(ATTACKER), True, 0.05) for _ in range(10)]
    assert orders[-1].skill == "push"


@pytest.mark.parametrize(("name", "role"), [("cyan1", GOALKEEPER), ("cyan4", DEFENDER)])
def test_agent_without_a_radio_leaves_the_ball_to_a_nearer_mate(name: str, role: str) -> None:
    bench = Bench(Agent, f"{name}/agent")
    model = world_model_t(localized=True, x_m=-5.0, ball=ball_estimate_t(known=True, x_m=2.0))
    model.silent_mates, model.n_silent_mates = [robot_estimate_t(x_m=1.0, vx_m_s=1.0)], 1
    bench.port("world_model").put(model)
    bench.port("game_state").put(state=game_state_t.PLAY)
    bench.iterate()
    assert bench.port("role").sent[-1].role == role


@pytest.mark.parametrize(("x_m", "role"), [(0.0, DEFENDER), (-9.5, ATTACKER)])
def test_ball_unseen_at_a_set_piece_lies_on_its_spot(x_m: float, role: str) -> None:
    """A robot in midfield once believed that it was the nearest to a ball in the corner, which no robot saw."""
    game = game_state_t(state=game_state_t.CORNER_KICK, state_team=game_state_t.TEAM_MAGENTA, stopped=True)
    game.ball_x_m, game.ball_y_m = -10.8, 6.8
    world, bench = Bench(WorldModel, "cyan4/world_model"), Bench(Agent, "cyan4/agent")
    world.port("game_state").put(game)
    world.iterate()
    model = world_model_t(localized=True, x_m=x_m, y_m=5.0, n_silent_mates=1)
    model.silent_mates = [robot_estimate_t(x_m=-8.0, y_m=4.0, vx_m_s=1.0)]
    model.ball = world.port("world_model").sent[-1].ball
    bench.port("world_model").put(model)
    bench.port("game_state").put(game)
    bench.iterate()
    assert bench.port("role").sent[-1].role == role


def test_robot_sent_off_does_not_count_for_the_rank() -> None:
    assert [rank_of(name, PLAYERS, ("cyan1", "magenta2")) for name in ("cyan2", "cyan3")] == [0, 1]


@pytest.mark.parametrize(
    ("heard", "kept"), [("cyan3", True), ("cyan1", False)], ids=["the lowest is silent", "the lowest speaks"]
)
def test_silent_robot_in_the_penalty_area_keeps_the_goal(heard: str, kept: bool) -> None:
    company, own, mates = Company(), robot("cyan2", 0.0, 0.0), (robot(heard, 1.0, 1.0),)
    seen = view(own, BALL, mates)._replace(silent_mates=(silent(-10.5, 0.0),))
    assert company.goal_is_kept(seen, FIELD, PLAYERS, (), 1.0) == kept
    assert company.goal_is_kept(view(own, BALL, mates), FIELD, PLAYERS, (), 1.0) == kept, "it is seen now and then"
    assert not company.goal_is_kept(view(own, BALL, mates), FIELD, PLAYERS, (), 1.5)
    assert not company.goal_is_kept(seen, FIELD, PLAYERS, ("cyan1",), 1.0)


def test_no_second_keeper_joins_one_without_a_radio() -> None:
    team = (robot("cyan3", -3.0, 1.0), robot("cyan4", -3.0, -1.0))
    seen = view(robot("cyan2", -4.0, 0.0), BALL, team)._replace(silent_mates=(silent(-10.5, 0.0),))
    assert assign(seen, FIELD)["cyan2"].role == GOALKEEPER
    assert GOALKEEPER not in {found.role for found in assign(seen, FIELD, goal_is_kept=True).values()}

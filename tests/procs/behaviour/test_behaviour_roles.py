"""Roles and positions: the same for every robot of the team, in any order of the mates."""

import itertools
import math

import numpy as np
import pytest

from procs.behaviour import formation, set_pieces
from procs.behaviour.game import Game, Whose
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, SUPPORTER, assign
from procs.behaviour.tactics import leave_field
from procs.behaviour.view import Robot, View
from procs.model.field import SIDES, Field, Point
from procs.model.game_states import State
from procs.model.geometry import between
from procs.model.robot import ABSENT
from tests.procs.behaviour.behaviour_parts import FIELD, agreed, ball, robot, view

TEAM = (
    robot("cyan1", -10.5, 0.0),
    robot("cyan2", -1.0, 0.5),
    robot("cyan3", -4.0, -2.0),
    robot("cyan4", -4.0, 2.0),
    robot("cyan5", 1.0, 4.0),
)


def test_robots_compute_the_same_jobs_in_any_order_of_mates() -> None:
    jobs = None
    for own in TEAM:
        mates = tuple(mate for mate in TEAM if mate is not own)
        for order in itertools.permutations(mates):
            found = assign(view(own, ball(0.0, 0.0), order), FIELD)
            jobs = jobs or found
            assert found == jobs
    assert jobs is not None
    assert {name: job.role for name, job in jobs.items()} == {
        "cyan1": GOALKEEPER,
        "cyan2": ATTACKER,
        "cyan3": SUPPORTER,
        "cyan4": DEFENDER,
        "cyan5": DEFENDER,
    }


def attackers(opponent_x_m: float, *team: Robot, presses: bool = True) -> set[str]:
    """Returns the robots that go for a ball in the middle while an opponent is in front of it."""
    seen = view(team[0], ball(0.0, 0.0), team[1:], (robot("magenta2", opponent_x_m, 0.0),))
    return {name for name, job in assign(seen, FIELD, presses).items() if job.role == ATTACKER}


def test_second_robot_presses_while_a_rival_is_sooner_at_ball() -> None:
    assert attackers(0.6, *TEAM) == {"cyan2", "cyan5"}
    assert attackers(0.6, *TEAM, presses=False) == {"cyan2"}
    assert attackers(3.0, *TEAM) == {"cyan2"}
    assert attackers(0.6, *TEAM[:3]) == {"cyan2"}, "one robot stays behind"


def test_second_attacker_presses_until_the_ball_is_surely_won() -> None:
    pressing = TEAM[4]._replace(role=ATTACKER)
    barely_sooner = next(x_m for x_m in np.arange(0.6, 3.0, 0.05) if attackers(x_m, *TEAM) == {"cyan2"})
    assert attackers(barely_sooner, *TEAM[:4], pressing) == {"cyan2", "cyan5"}
    assert attackers(4.0, *TEAM[:4], pressing) == {"cyan2"}


def test_robots_at_one_position_agree_on_the_attacker() -> None:
    twins = (robot("cyan3", -4.0, 0.0), robot("cyan4", -4.0, 0.0))
    orders = [(TEAM[0], TEAM[1], *pair) for pair in (twins, twins[::-1])]
    first, second = (assign(view(TEAM[4], ball(0.0, 0.0), order), FIELD) for order in orders)
    assert first == second


def test_lone_robot_attacks_and_lower_number_of_two_keeps_goal() -> None:
    alone = assign(view(TEAM[0], ball(0.0, 0.0)), FIELD)
    assert alone["cyan1"].role == ATTACKER
    two = assign(view(TEAM[2], ball(-4.0, -2.0), (TEAM[1],)), FIELD)
    assert (two["cyan2"].role, two["cyan3"].role) == (GOALKEEPER, ATTACKER)


def test_lone_robot_keeps_the_goal_at_their_penalty_only() -> None:
    for whose, role in ((Whose.THEIRS, GOALKEEPER), (Whose.OURS, ATTACKER)):
        game = Game(State.PENALTY, stopped=True, whose=whose, spot=Point(-7.4, 0.0))
        assert assign(view(TEAM[2], ball(-7.4, 0.0)), FIELD, game=game)["cyan3"].role == role


def test_keeper_that_does_not_play_is_replaced_when_it_is_off() -> None:
    """Until then the referee takes the lowest number for the goalkeeper, and another robot in the area for a foul."""
    silent = TEAM[0]._replace(role=ABSENT)
    seen = view(TEAM[2], ball(-4.0, -2.0), (silent, TEAM[1], *TEAM[3:]))
    there, off = assign(seen, FIELD), assign(seen.without(("cyan1",)), FIELD)
    assert sorted(there) == ["cyan2", "cyan3", "cyan4", "cyan5"]
    assert GOALKEEPER not in {job.role for job in there.values()}
    assert off["cyan2"].role == GOALKEEPER


def test_attacker_keeps_its_role_against_a_barely_faster_mate() -> None:
    new, old = robot("cyan2", -1.0, 0.0), robot("cyan3", -1.3, 0.0, role=ATTACKER)
    keeper = TEAM[0]
    assert assign(view(new, ball(0.0, 0.0), (old, keeper)), FIELD)["cyan3"].role == ATTACKER
    far = robot("cyan3", -4.0, 0.0, role=ATTACKER)
    assert assign(view(new, ball(0.0, 0.0), (far, keeper)), FIELD)["cyan2"].role == ATTACKER


def test_first_robot_at_a_rolling_ball_attacks() -> None:
    behind, ahead = robot("cyan2", -1.0, 0.0), robot("cyan3", 4.0, 0.5)
    jobs = assign(view(behind, ball(0.0, 0.0, 3.0, 0.0), (ahead, TEAM[0])), FIELD)
    assert jobs["cyan3"].role == ATTACKER


def test_dribbler_stays_attacker_when_the_ball_nears_a_mate() -> None:
    dribbler, ahead = robot("cyan2", 0.0, 0.0, role=ATTACKER), robot("cyan3", 1.5, 0.2)
    jobs = assign(view(dribbler, ball(0.33, 0.0, 2.0, 0.0), (ahead, TEAM[0])), FIELD)
    assert jobs["cyan2"].role == ATTACKER


def test_supporter_changes_its_flank_only_for_a_clear_ball() -> None:
    supporter = robot("cyan5", 3.0, 3.0, role=SUPPORTER)
    for y_m, flank in ((0.5, 1.0), (2.5, -1.0)):
        jobs = assign(view(supporter, ball(0.0, y_m), (TEAM[0], TEAM[1])), FIELD)
        assert jobs["cyan5"].place.y_m * flank > 0


def test_robot_that_awaits_an_agreed_pass_keeps_its_role() -> None:
    taker, rival = robot("cyan2", -0.8, 0.0, role=ATTACKER), robot("cyan3", 3.0, -3.5, role=DEFENDER)
    waiting = robot("cyan4", -2.0, 3.0, role=SUPPORTER)
    agree = agreed(waiting)
    roles = [
        assign(view(taker, ball(0.0, 0.0), (TEAM[0], rival, mate)), FIELD)["cyan4"].role for mate in (waiting, agree)
    ]
    assert roles == [DEFENDER, SUPPORTER]


def test_robot_without_a_pose_has_no_job_but_its_mates_have() -> None:
    lost = View(localized=False, own=TEAM[1], ball=ball(0.0, 0.0), mates=(TEAM[0], TEAM[2]))
    assert set(assign(lost, FIELD)) == {"cyan1", "cyan3"}


def test_six_robots_all_have_jobs() -> None:
    six = (*TEAM, robot("cyan6", 2.0, 2.0), robot("cyan7", 2.0, -2.0))
    assert set(assign(view(six[0], ball(0.0, 0.0), six[1:]), FIELD)) == {mate.name for mate in six}


@pytest.mark.parametrize("ours", [True, False])
def test_places_of_the_formation_are_apart_for_any_ball(ours: bool) -> None:
    for x_m, y_m in itertools.product(range(-11, 12), range(-7, 8)):
        found = formation.places(Point(x_m, y_m), ours, math.copysign(1.0, -y_m), FIELD)
        assert min(math.dist(*pair) for pair in itertools.combinations(found, 2)) > 0.75, (x_m, y_m)


@pytest.mark.parametrize("number", [7, 8, 11])
@pytest.mark.parametrize("where", [(0.0, 0.0), (-10.0, -6.0), (-8.0, -1.0), (10.0, 6.5), (6.0, 0.3), (-4.0, 3.0)])
def test_robots_of_a_large_team_have_places_apart(number: int, where: tuple[float, float]) -> None:
    team = tuple(robot(f"cyan{index}", -index / 2, (-1) ** index * 3.0) for index in range(1, number + 1))
    found = [assign(view(own, ball(*where), tuple(one for one in team if one is not own)), FIELD) for own in team[:2]]
    assert found[0] == found[1]
    further = [job.place for job in found[0].values() if job.role in (DEFENDER, SUPPORTER)]
    assert len(further) == number - 2
    assert min(math.dist(*pair) for pair in itertools.combinations(further, 2)) > 0.75
    possible = itertools.product((True, False), (1.0, -1.0))
    usual = {place for ours, flank in possible for place in formation.places(Point(*where), ours, flank, FIELD)}
    assert all(FIELD.in_field(*each) and not FIELD.in_penalty_area(*each, -1.0) for each in {*further} - usual)


@pytest.mark.parametrize("state", [State.KICK_OFF, State.THROW_IN, State.FREE_KICK, State.CORNER_KICK, State.DROP_BALL])
@pytest.mark.parametrize("whose", Whose)
@pytest.mark.parametrize("spot", [Point(0.0, 0.0), Point(10.8, 6.8), Point(-10.8, -6.8), Point(-3.0, 6.9)])
def test_positions_at_set_pieces_keep_the_distance(state: State, whose: Whose, spot: Point) -> None:
    if state is State.KICK_OFF and spot != (0.0, 0.0):
        return
    game = Game(state, stopped=True, whose=whose, spot=spot)
    needed_m = 1.0 if state is State.DROP_BALL else 2.0 if whose is Whose.OURS else 3.0
    wanted = [*formation.places(spot, True, 1.0, FIELD), *formation.places(spot, False, -1.0, FIELD), spot]
    for place in [formation.allowed(one, game, FIELD) for one in wanted] + [
        formation.first_opponent_place(game, FIELD)
    ]:
        assert math.dist(place, spot) >= needed_m
        assert FIELD.in_field(*place, 0.0)
        assert state is not State.KICK_OFF or place.x_m <= -0.25


@pytest.mark.parametrize("y_m", [-1.5, 0.0, 0.75])
def test_free_kick_near_a_small_goal_is_met_beside_the_way(y_m: float) -> None:
    areas = {"penalty_area_width_m": 4.0, "penalty_area_depth_m": 1.5, "goal_area_width_m": 3.0}
    field = Field(length_m=9.0, width_m=6.0, restart_offset_m=1.0, penalty_mark_distance_m=1.8, **areas)
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(-2.7, y_m))
    place = formation.first_opponent_place(game, field)
    assert math.dist(place, game.spot) >= 3.0
    assert field.in_field(*place)
    assert not field.in_penalty_area(*place, -1.0)


@pytest.mark.parametrize("own", [Point(-2.0, 5.0), Point(-1.0, 1.0), Point(2.0, 0.0)])
def test_path_to_a_position_leads_around_a_set_pieces_ball(own: Point) -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(0.0, 0.0))
    place = Point(-2.0, -5.0)
    distances_m = [math.dist(own, game.spot)]
    for _ in range(400):
        step = formation.next_step(own, place, game, FIELD)
        way_m = math.dist(own, step)
        share = min(1.0, 0.1 / way_m) if way_m else 1.0
        own = Point(own.x_m + share * (step.x_m - own.x_m), own.y_m + share * (step.y_m - own.y_m))
        distances_m.append(math.dist(own, game.spot))
    assert own == pytest.approx(place)
    outside = next(index for index, distance_m in enumerate(distances_m) if distance_m > 3.0)
    assert outside < 40
    assert min(distances_m[outside:]) > 3.0


def test_robot_at_the_wall_leaves_the_ball_along_the_line() -> None:
    game = Game(State.THROW_IN, stopped=True, whose=Whose.THEIRS, spot=Point(9.55, 6.9))
    step = formation.next_step(Point(11.65, 7.65), Point(5.0, 3.0), game, FIELD)
    assert math.dist(step, game.spot) > 3.0
    assert FIELD.in_field(*step, 0.5)


@pytest.mark.parametrize("spot", [Point(-3.15, 5.84), Point(-3.15, -6.9)])
def test_path_around_a_ball_near_the_wall_is_the_fields_side(spot: Point) -> None:
    """The way at the wall is too narrow: a robot that tried it drove to and fro there."""
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=spot)
    own, place = Point(-0.34, math.copysign(7.2, spot.y_m)), Point(-5.6, spot.y_m)
    for _ in range(100):
        assert math.dist(own, spot) > 2.1
        step = formation.next_step(own, place, game, FIELD)
        share = min(1.0, 0.1 / max(0.1, math.dist(own, step)))
        x_m, y_m = own.x_m + share * (step.x_m - own.x_m), own.y_m + share * (step.y_m - own.y_m)
        own = Point(x_m, max(-7.75, min(7.75, y_m)))
    assert own == pytest.approx(place)


def test_robot_before_its_keeper_leaves_the_ball_beside_it() -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(-7.4, -0.4))
    keeper = robot("cyan1", -10.55, -0.1)
    step = formation.next_step(Point(-9.65, -0.35), Point(-4.0, 3.0), game, FIELD, (keeper,))
    assert math.dist(step, game.spot) > 3.0
    assert math.dist(step, keeper.place) > 0.56
    assert not FIELD.in_penalty_area(*step, -1.0)


def test_defenders_stand_between_ball_and_penalty_area() -> None:
    for where in (Point(4.0, 3.0), Point(-6.0, -3.0), Point(-10.0, 0.5)):
        _, stopper, sweeper, _ = formation.places(where, ours=False, flank=1.0, field=FIELD)
        assert not FIELD.in_penalty_area(*stopper, -1.0)
        assert not FIELD.in_penalty_area(*sweeper, -1.0)


@pytest.mark.parametrize("spot", [Point(-7.4, -0.7), Point(-7.4, 3.0), Point(-8.5, 5.0)])
def test_set_piece_near_the_goal_sends_no_player_into_an_area(spot: Point) -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=spot)
    first = formation.first_opponent_place(game, FIELD)
    helpers = [formation.helper_place(post, game, FIELD) for post in formation.places(spot, False, 1.0, FIELD)]
    for place in [first, *helpers]:
        assert not FIELD.in_penalty_area(*place, -1.0, 0.25), place
        assert math.dist(place, spot) >= 3.0
    assert all(math.dist(place, first) >= 0.99 for place in helpers)


@pytest.mark.parametrize(("length_m", "width_m"), [(12.0, 8.0), (18.0, 12.0), (22.0, 14.0)])
@pytest.mark.parametrize("ours", [True, False])
@pytest.mark.parametrize("flank", [1.0, -1.0])
def test_posts_fit_fields_of_all_sizes(length_m: float, width_m: float, ours: bool, flank: float) -> None:
    field = Field(length_m=length_m, width_m=width_m)
    for x, y in itertools.product((-0.95, -0.5, 0.0, 0.5, 0.95), (-0.9, -0.3, 0.0, 0.3, 0.9)):
        where = Point(x * field.half_length_m, y * field.half_width_m)
        supporter, stopper, sweeper, spare = formation.places(where, ours, flank, field)
        assert all(field.in_field(*post) for post in (supporter, stopper, sweeper, spare))
        for post in (supporter, sweeper, spare):
            assert not any(field.in_penalty_area(*post, side, 0.3) for side in SIDES)
        assert not field.in_goal_area(*stopper, -1.0, 0.3)
        assert stopper.x_m <= max(where.x_m, 3.0 - field.half_length_m)
        assert supporter.x_m >= min(sweeper.x_m, spare.x_m)


@pytest.mark.parametrize(("length_m", "width_m"), [(12.0, 8.0), (18.0, 12.0), (22.0, 14.0)])
def test_receivers_and_bench_fit_fields_of_all_sizes(length_m: float, width_m: float) -> None:
    field = Field(length_m=length_m, width_m=width_m)
    spots = {
        State.KICK_OFF: Point(0.0, 0.0),
        State.THROW_IN: Point(-1.0, field.half_width_m - 0.2),
        State.GOAL_KICK: Point(3.6 - field.half_length_m, field.restart_offset_m),
        State.CORNER_KICK: Point(field.half_length_m - 0.2, field.half_width_m - 0.2),
    }
    for state, spot in spots.items():
        game = Game(state, stopped=True, whose=Whose.OURS, spot=spot)
        for variant in set_pieces.BOOK[state]:
            place = set_pieces.receiver_place(variant, game, field)
            assert field.in_field(*place), variant.name
            assert not any(field.in_penalty_area(*place, side) for side in SIDES), variant.name
    place = leave_field(view(robot("cyan2", field.half_length_m, 1.0), ball(0.0, 0.0)), Game(), field).place
    assert abs(place.x_m) == field.half_length_m - 3.0


def test_robot_that_is_sent_off_keeps_out_of_the_circle() -> None:
    game = Game(State.FREE_KICK, whose=Whose.THEIRS, spot=Point(0.0, 4.0))
    for y_m in (0.5, 2.5):  # outside, before the circle, and in it
        own = robot("cyan2", 0.1, y_m)
        place = leave_field(view(own, ball(*game.spot)), game, FIELD).place
        nearest_m = min(math.dist(between(own.place, place, step / 20), game.spot) for step in range(21))
        assert nearest_m >= min(3.0, math.dist(own.place, game.spot) - 0.01)
        assert math.dist(place, game.spot) >= 3.0


def test_posts_on_the_usual_field_stay_where_they_were() -> None:
    places = formation.places(Point(1.3, 0.7), True, 1.0, FIELD)
    assert places == [Point(4.3, 2.5), Point(-4.85, 0.35), Point(2.3, -2.8), Point(-1.7, -1.3)]

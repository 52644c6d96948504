"""Steadiness of roles: a contested ball changes who meets it first with every touch."""

from typing import Any

import pytest

from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, SUPPORTER
from procs.behaviour.steady_role import SteadyRole
from procs.behaviour.view import View
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import agreed, ball, job, robot, view

TICK_S = 0.04
FAR = view(robot("cyan3", -3.0, 0.0), ball(0.0, 0.0), (robot("cyan2", 0.5, 0.0, role=ATTACKER),))


def taken(assigned: list[str], seen: View = FAR, **game: Any) -> list[str]:
    """Returns the role of each tick for those that were assigned."""
    steady, free_play = SteadyRole(), game.get("free_play", True)
    return [steady.job(job(role), seen, free_play, TICK_S).role for role in assigned]


def test_role_that_is_assigned_now_and_then_is_not_taken() -> None:
    flickering = [DEFENDER, *([ATTACKER] * 5 + [DEFENDER]) * 4, *([SUPPORTER] * 3 + [ATTACKER] * 2 + [DEFENDER]) * 4]
    assert set(taken(flickering)) == {DEFENDER}


def test_role_that_stays_assigned_is_taken_after_a_while() -> None:
    roles = taken([DEFENDER] + [SUPPORTER] * 12)
    assert roles.index(SUPPORTER) * TICK_S == pytest.approx(0.32)
    assert set(roles[roles.index(SUPPORTER) :]) == {SUPPORTER}


def test_newest_of_several_other_roles_is_taken() -> None:
    assert taken([DEFENDER] + [SUPPORTER, ATTACKER] * 6)[-1] != DEFENDER


@pytest.mark.parametrize(
    "seen",
    [
        FAR._replace(own=robot("cyan3", -0.35, 0.0)),
        FAR._replace(own=agreed(robot("cyan3", -3.0, 0.0))),
        FAR._replace(mates=(robot("cyan2", 0.5, 0.0, role=SUPPORTER),)),
    ],
    ids=["at the ball", "awaits a pass", "no other attacks"],
)
def test_robot_that_has_to_attack_does_so_at_once(seen: View) -> None:
    assert taken([DEFENDER, ATTACKER], seen) == [DEFENDER, ATTACKER]
    assert taken([DEFENDER, SUPPORTER], seen) == [DEFENDER, DEFENDER]


def test_goalkeeper_and_set_pieces_have_no_patience() -> None:
    assert taken([DEFENDER, GOALKEEPER, DEFENDER]) == [DEFENDER, GOALKEEPER, DEFENDER]
    assert taken([DEFENDER, SUPPORTER], free_play=False) == [DEFENDER, SUPPORTER]


def test_attacker_follows_the_ball_until_it_has_another_role() -> None:
    steady = SteadyRole()
    steady.job(job(ATTACKER), FAR, True, TICK_S)
    moved = FAR._replace(ball=ball(1.0, 2.0))
    assert steady.job(job(DEFENDER, -4.0, 1.0), moved, True, TICK_S) == job(ATTACKER, 1.0, 2.0)


def test_place_of_the_kept_role_moves_with_the_formation() -> None:
    steady = SteadyRole()
    steady.job(job(DEFENDER, -4.0, 1.0), FAR, True, TICK_S)
    assert steady.job(job(DEFENDER, -4.5, 1.5), FAR, True, TICK_S).place == Point(-4.5, 1.5)

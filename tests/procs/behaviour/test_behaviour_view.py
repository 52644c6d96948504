"""The world model as a robot's view in the attack frame."""

import math
from typing import Any

import pytest

from lcmtypes.soccer import mate_estimate_t, pass_agreement_t, robot_estimate_t, world_model_t
from procs.behaviour.bodies import USUAL
from procs.behaviour.obstacles import discs, movers
from procs.behaviour.view import Agreement, Frame, View, view_of
from procs.model.field import Field, Point


def seen(turned: bool = False, **lists: Any) -> View:
    return view_of(world_model_t(localized=True, **lists), "magenta2", "", Frame(-1.0 if turned else 1.0))


def test_each_mate_has_its_own_role_and_agreement() -> None:
    said = pass_agreement_t(receiver="magenta3", x_m=1.0, y_m=2.0)
    passer = mate_estimate_t(name="magenta4", number=4, x_m=3.0, role="passer", agreement=said)
    silent = mate_estimate_t(name="magenta9", age_s=2.5, role="attacker")
    receiver = mate_estimate_t(name="magenta3", number=3, role="attacker")
    receiver.agreement.passer = "magenta4"
    one, other = seen(turned=True, mates=[passer, silent, receiver]).mates
    assert (one.name, one.number, one.role, one.place) == ("magenta4", 4, "passer", Point(-3.0, 0.0))
    assert one.agreement == Agreement("magenta3", Point(-1.0, -2.0))
    assert (other.name, other.role, other.agreement.passer) == ("magenta3", "attacker", "magenta4")


def test_opponent_has_place_and_velocity_but_no_name() -> None:
    (opponent,) = seen(turned=True, opponents=[robot_estimate_t(x_m=2.0, vy_m_s=1.0)]).opponents
    assert (opponent.place, opponent.velocity_m_s) == (Point(-2.0, 0.0), Point(0.0, -1.0))
    assert (opponent.name, opponent.number, opponent.role) == ("", 0, "")


@pytest.mark.parametrize("field", ["x_m", "vy_m_s", "heading_rad"])
def test_mate_with_an_implausible_value_is_left_out(field: str) -> None:
    mate = mate_estimate_t(name="magenta3")
    setattr(mate, field, math.nan)
    assert seen(mates=[mate]).mates == ()


@pytest.mark.parametrize("field", ["y_m", "vx_m_s"])
def test_opponent_with_an_implausible_value_is_left_out(field: str) -> None:
    opponent = robot_estimate_t()
    setattr(opponent, field, math.inf)
    assert seen(opponents=[opponent]).opponents == ()


@pytest.mark.parametrize("who", ["opponents", "silent_mates"])
def test_robot_that_tells_nothing_never_gives_way(who: str) -> None:
    model = world_model_t()
    setattr(model, who, [robot_estimate_t(x_m=2.0, vx_m_s=-2.0)])
    assert [each.gives_way for each in movers(model, 0.1)] == [False]
    assert [disc.middle.y_m for disc in discs(model, Field(), USUAL, True, False)] == [0.0]


def test_silent_mate_is_in_the_way_but_no_player() -> None:
    view = seen(silent_mates=[robot_estimate_t(x_m=2.0), robot_estimate_t(x_m=math.nan)])
    assert (view.mates, view.opponents) == ((), ())
    assert [robot.place for robot in view.others] == [Point(2.0, 0.0)]


def test_zero_of_one_team_is_that_of_the_other() -> None:
    turned = [Frame(sign).point(0.0, -0.0) for sign in (1.0, -1.0)]
    assert [math.copysign(1.0, value) for point in turned for value in point] == [1.0] * 4


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_heading_that_is_no_angle_stays_so_in_both_frames(sign: float) -> None:
    assert Frame(sign).heading_rad(math.inf) == math.inf
    assert math.isnan(Frame(sign).heading_rad(math.nan))

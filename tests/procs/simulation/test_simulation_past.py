"""The true world a short time ago: between two messages, after a placement, before the first one."""

import math

import pytest

from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.simulation.past import Past


def truth(time_us: int, x_m: float, heading_rad: float, ball_x_m: float) -> ground_truth_t:
    made, robot = ground_truth_t(), true_robot_t()
    made.header.time_us, made.ball_x_m, made.ball_z_m = time_us, ball_x_m, 0.2
    robot.name, robot.team, robot.number = "cyan1", "cyan", 1
    robot.x_m, robot.heading_rad, robot.vx_m_s = x_m, heading_rad, 2.0
    made.robots = [robot]
    return made


def past(*worlds: ground_truth_t) -> Past:
    made = Past()
    for world in worlds:
        made.add(world)
    return made


def test_between_two_messages_everything_moves_straight() -> None:
    world = past(truth(50_000, 1.0, math.pi - 0.1, 0.0), truth(100_000, 1.1, -math.pi + 0.1, 0.4)).at(65_000)
    robot = world.robots[0]
    assert (robot.x_m, robot.vx_m_s) == pytest.approx((1.03, 2.0))
    assert (robot.team, robot.number) == ("cyan", 1)
    assert robot.heading_rad == pytest.approx(math.pi - 0.04)
    assert (world.ball_x_m, world.ball_z_m) == pytest.approx((0.12, 0.2))


def test_what_was_placed_is_not_seen_on_the_way() -> None:
    world = past(truth(50_000, -3.0, 0.0, 5.0), truth(100_000, 3.0, 0.0, -5.0)).at(65_000)
    assert (world.robots[0].x_m, world.ball_x_m) == (3.0, -5.0)


def test_robot_turned_by_hand_is_not_seen_on_the_way() -> None:
    world = past(truth(40_000, 1.0, 0.0, 0.0), truth(80_000, 1.0, 2.5, 0.0)).at(45_000)
    assert world.robots[0].heading_rad == 2.5


def test_ball_lifted_by_hand_is_not_seen_on_the_way() -> None:
    before, after = truth(40_000, 1.0, 0.0, 0.0), truth(80_000, 1.0, 0.0, 0.0)
    after.ball_z_m = 3.0
    assert past(before, after).at(45_000).ball_z_m == 3.0


@pytest.mark.parametrize("omega_rad_s", [20.0, -20.0])
def test_robot_that_spins_is_seen_on_its_way(omega_rad_s: float) -> None:
    before, after = truth(40_000, 1.0, 0.0, 0.0), truth(80_000, 1.0, 0.04 * omega_rad_s, 0.0)
    before.robots[0].omega_rad_s = after.robots[0].omega_rad_s = omega_rad_s
    assert past(before, after).at(60_000).robots[0].heading_rad == pytest.approx(0.02 * omega_rad_s)


@pytest.mark.parametrize("span_us", [20_000, 100_000])
@pytest.mark.parametrize(("vx_m_s", "vy_m_s"), [(15.0, 15.0), (-15.0, 15.0), (24.0, 0.0)])
def test_fastest_ball_is_seen_on_its_way(vx_m_s: float, vy_m_s: float, span_us: int) -> None:
    before, after = truth(50_000, 0.0, 0.0, 1.0), truth(50_000 + span_us, 0.0, 0.0, 1.0)
    for made in (before, after):
        made.ball_vx_m_s, made.ball_vy_m_s = vx_m_s, vy_m_s
    after.ball_x_m, after.ball_y_m = 1.0 + vx_m_s * span_us / 1e6, vy_m_s * span_us / 1e6
    world = past(before, after).at(50_000 + span_us // 4)
    assert (world.ball_x_m, world.ball_y_m) == pytest.approx((1.0 + vx_m_s * span_us / 4e6, vy_m_s * span_us / 4e6))


@pytest.mark.parametrize("way_m", [0.7, 1.8, -1.8])
def test_robot_placed_near_by_is_not_seen_on_the_way(way_m: float) -> None:
    """At 10 Hz; it drove at 2 m/s, and stands after it was placed."""
    before, after = truth(100_000, 1.0, 0.0, 0.0), truth(200_000, 1.0 + way_m, 0.0, 0.0)
    after.robots[0].vx_m_s = 0.0
    assert past(before, after).at(150_000).robots[0].x_m == 1.0 + way_m


@pytest.mark.parametrize(("before_m_s", "after_m_s"), [(0.0, 0.5), (3.0, -2.0), (3.0, 0.0), (0.0, 0.0)])
def test_robot_that_is_bumped_is_seen_on_its_way(before_m_s: float, after_m_s: float) -> None:
    before, after = truth(40_000, 1.0, 0.0, 0.0), truth(80_000, 1.1, 0.0, 0.0)
    before.robots[0].vx_m_s, after.robots[0].vx_m_s = before_m_s, after_m_s
    assert past(before, after).at(60_000).robots[0].x_m == pytest.approx(1.05)


def test_before_the_first_message_the_world_is_as_in_it() -> None:
    assert past(truth(50_000, 1.0, 0.0, 0.0), truth(100_000, 1.1, 0.0, 0.0)).at(10_000).robots[0].x_m == 1.0


def test_short_ticks_do_not_shorten_the_memory() -> None:
    worlds = [truth(tick * 5_000, 0.01 * tick, 0.0, 0.0) for tick in range(1, 400)]
    assert past(*worlds).at(1_000_000).robots[0].x_m == pytest.approx(2.0)

"""A ball in the air above robots and goals."""

import math

import numpy as np
import pytest

from procs.model.ball import BALL, BallModel
from procs.model.events import Event, Kind
from procs.model.robot import ROBOT
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World

TICK_US = 40_000
AWAY_M = ROBOT.radius_m + BALL.radius_m


def world_of(heading_rad: float = 0.0) -> World:
    return World(["cyan1"], np.random.default_rng(1), starts={"cyan1": Pose(0.0, 0.0, heading_rad)})


def run(world: World, ticks: int) -> list[Event]:
    return [event for _ in range(ticks) for event in world.advance(TICK_US)]


@pytest.mark.parametrize("heading_rad", [0.0, 2.0, math.pi])
@pytest.mark.parametrize("vx_m_s", [-1.0, 0.0, 3.0])
@pytest.mark.parametrize("x_m", [0.0, 0.1, 0.2, 0.24])
def test_ball_that_falls_on_a_robot_rolls_off(x_m: float, vx_m_s: float, heading_rad: float) -> None:
    world = world_of(heading_rad)
    world.ball.put(x_m, 0.0)
    world.throw_ball(1.5, (vx_m_s, 0.0, 0.0))
    for _ in range(150):
        world.advance(10_000)
        away_m = math.dist(world.ball.body.position, world.robots["cyan1"].body.position)
        inside = world.ball.z_m < ROBOT.height_m - 1e-6 and away_m < ROBOT.mouth_m
        assert not inside, f"{away_m:.3f} m from the middle, {world.ball.z_m:.3f} m high"
    assert math.dist(world.ball.body.position, world.robots["cyan1"].body.position) > AWAY_M - 0.05
    assert world.ball.z_m < ROBOT.height_m


def test_ball_bounces_off_the_top_of_a_robot() -> None:
    world = world_of()
    world.ball.put(0.0, 0.0)
    world.throw_ball(ROBOT.height_m + 0.5, (0.0, 0.0, 0.0))
    heights_m = []
    for _ in range(60):
        world.advance(10_000)
        heights_m.append(world.ball.z_m)
    lowest = int(np.argmin(heights_m[:40]))
    assert heights_m[lowest] == pytest.approx(ROBOT.height_m, abs=0.03)
    assert max(heights_m[lowest:]) == pytest.approx(ROBOT.height_m + 0.5**2 * 0.5, abs=0.02)


def test_robot_on_which_the_ball_falls_has_touched_it() -> None:
    world = world_of()
    world.ball.put(0.1, 0.0)
    world.throw_ball(ROBOT.height_m + 0.1, (0.0, 0.0, 0.0))
    assert {(event.kind, event.robot) for event in run(world, 4)} == {(Kind.TOUCH, "cyan1")}
    assert world.last_touch == "cyan1"


@pytest.mark.parametrize("height_m", [0.8, 0.9, 1.1])
def test_ball_put_down_behind_a_bar_has_not_hit_it(height_m: float) -> None:
    world = world_of()
    world.place_ball(5.0, 0.0)
    run(world, 1)
    world.place_ball(11.3, 0.5)
    world.throw_ball(height_m, (0.0, 0.0, 0.0))
    run(world, 1)
    assert world.ball.body.position == pytest.approx((11.3, 0.5))


@pytest.mark.parametrize("bounce", [0.9, 0.99, 1.0])
def test_bouncing_ball_rises_no_higher_than_before(bounce: float) -> None:
    world = World([], np.random.default_rng(1), ball=BallModel(bounce=bounce))
    world.place_ball(0.0, 0.0)
    world.throw_ball(1.0, (0.0, 0.0, 0.0))
    for _ in range(2000):
        world.advance(10_000)
        assert world.ball.z_m <= 1.0


@pytest.mark.parametrize("bounce", [0.6, 0.9, 0.99])
def test_each_bounce_takes_its_share_of_the_speed(bounce: float) -> None:
    world = World([], np.random.default_rng(1), ball=BallModel(bounce=bounce))
    world.place_ball(0.0, 0.0)
    world.throw_ball(1.0, (0.0, 0.0, 0.0))
    heights_m = [0.0]
    while len(heights_m) < 5:
        falling = world.ball.vz_m_s < 0.0
        world.advance(5_000)
        if falling and world.ball.vz_m_s >= 0.0:
            heights_m.append(0.0)
        heights_m[-1] = max(heights_m[-1], world.ball.z_m)
    assert heights_m[:3] == pytest.approx([1.0, bounce**2, bounce**4], abs=0.001)


@pytest.mark.parametrize("bounce", [0.0, 0.6, 0.9, 1.0])
def test_ball_that_bounces_to_the_last_comes_to_rest(bounce: float) -> None:
    """The ground brakes it once it stays down, however small the least rebound is."""
    world = World([], np.random.default_rng(1), ball=BallModel(bounce=bounce, least_rebound_m_s=0.0))
    world.place_ball(0.0, 0.0)
    world.throw_ball(0.0001, (1.0, 0.0, 0.0))
    run(world, 150)
    assert (world.ball.z_m, world.ball.speed_m_s) == (0.0, 0.0)


@pytest.mark.parametrize(("height_m", "passes"), [(0.3, False), (0.7, True)])
def test_ball_thrown_over_a_robot_beside_it_passes(height_m: float, passes: bool) -> None:
    world = world_of()
    world.place_ball(-AWAY_M - 0.03, 0.0)
    world.throw_ball(height_m, (10.0, 0.0, 2.0))
    run(world, 3)
    assert (world.ball.body.position.x > 0.5) is passes


@pytest.mark.parametrize(("x_m", "kind"), [(10.1, Kind.GOAL), (9.8, Kind.GOAL), (9.0, Kind.OUT_END)])
def test_lob_that_still_rises_under_the_bar_is_a_goal(x_m: float, kind: Kind) -> None:
    """Behind the line it may be higher than the bar is."""
    world = World(["cyan1"], np.random.default_rng(1), starts={"cyan1": Pose(x_m, 0.3, 0.0)})
    world.ball.put(x_m + ROBOT.held_ball_m(BALL), 0.3)
    world.kickers["cyan1"].command(KickerCommand(1, 6.0, dribble=False, elevation_rad=0.8), 0)
    assert [event.kind for event in run(world, 15) if event.kind in (Kind.GOAL, Kind.OUT_END)] == [kind]

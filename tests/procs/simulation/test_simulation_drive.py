"""Robots on their wheels: speeds, grip, delay."""

import math

import numpy as np
import pytest

from procs.model.kinematics import STANDSTILL, Velocity, velocity_of, wheels_of
from procs.simulation.physics.realism import Noise
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World

TICK_US = 50_000
START = Pose(-8.0, 0.0, 0.0)


def one_robot(noise: Noise | None = None, pose: Pose = START) -> World:
    return World(["cyan1"], np.random.default_rng(1), noise=noise, starts={"cyan1": pose})


def drive(world: World, velocity: Velocity, ticks: int) -> Velocity:
    robot = world.robots["cyan1"]
    for _ in range(ticks):
        robot.drive.command(wheels_of(velocity, 0.2), world.time_us)
        world.advance(TICK_US)
    return robot.velocity


@pytest.mark.parametrize("wanted", [Velocity(2.0, 0.0, 0.0), Velocity(0.0, 1.5, 0.0), Velocity(1.0, -1.0, 0.0)])
def test_robot_reaches_the_velocity_that_its_wheels_turn_for(wanted: Velocity) -> None:
    assert drive(one_robot(), wanted, 40) == pytest.approx(wanted, abs=0.01)


def test_robot_turns_on_the_spot_at_the_commanded_speed() -> None:
    world = one_robot()
    assert drive(world, Velocity(0.0, 0.0, 5.0), 40).omega_rad_s == pytest.approx(5.0, abs=0.01)
    assert world.robots["cyan1"].body.position == pytest.approx((-8.0, 0.0), abs=0.01)


def test_wheels_limit_the_top_speed() -> None:
    assert drive(one_robot(), Velocity(9.0, 0.0, 0.0), 40).vx_m_s == pytest.approx(3.5 / (math.sqrt(3) / 2), abs=0.02)


def test_grip_limits_the_acceleration_while_wheels_spin() -> None:
    world = one_robot()
    robot = world.robots["cyan1"]
    drive(world, Velocity(3.0, 0.0, 0.0), 4)
    # Two of three wheels push forward, at an angle of 30 degrees.
    grip_m_s2 = 0.8 * 9.81 * 2 / 3 * math.cos(math.radians(30))
    before_m_s = robot.velocity.vx_m_s
    assert velocity_of(robot.drive.wheels_m_s, 0.2).vx_m_s > before_m_s + 0.5
    assert drive(world, Velocity(3.0, 0.0, 0.0), 1).vx_m_s - before_m_s == pytest.approx(grip_m_s2 * 0.05, rel=0.03)


def test_gentle_acceleration_hardly_slips() -> None:
    world = one_robot()
    robot = world.robots["cyan1"]
    for tick in range(40):
        drive(world, Velocity(1.0 * tick * 0.05, 0.0, 0.0), 1)
        slip_m_s = velocity_of(robot.drive.wheels_m_s, 0.2).vx_m_s - robot.velocity.vx_m_s
        assert abs(slip_m_s) < 0.03


def test_delayed_command_moves_nothing_before_its_time() -> None:
    world = one_robot(Noise(drive_delay_s=0.1))
    assert drive(world, Velocity(1.0, 0.0, 0.0), 2) == STANDSTILL
    assert drive(world, Velocity(1.0, 0.0, 0.0), 1).vx_m_s > 0.1


def test_measured_speeds_are_the_mean_over_the_tick() -> None:
    world = one_robot()
    robot = world.robots["cyan1"]
    drive(world, Velocity(0.0, 0.0, 5.0), 1)
    after_one_tick = robot.drive.measured_m_s()
    # A first-order lag of 50 ms: after one time constant the mean is 1/e of the end value.
    assert after_one_tick == pytest.approx([1.0 / math.e] * 3)
    assert robot.drive.measured_m_s() == robot.drive.wheels_m_s


def test_measured_speeds_count_new_commands_and_stuck_wheels() -> None:
    world = one_robot(Noise(drive_delay_s=0.03), Pose(0.0, 0.0, 0.0))
    motors, step_us, way_m = world.robots["cyan1"].drive, 500, np.zeros(3)
    motors.measured_m_s()
    for step in range(400):
        if step % 40 == 0:
            motors.command((1.0 - 0.2 * (step // 40), 0.5, -2.0), world.time_us)
        if step in (100, 300):
            motors.stuck = frozenset({1} if step == 100 else ())
        before_m_s = np.array(motors.wheels_m_s)
        world.advance(step_us)
        way_m += (before_m_s + motors.wheels_m_s) / 2 * step_us / 1e6
    assert motors.measured_m_s() == pytest.approx(way_m / 0.2, abs=1e-4)


def test_command_that_is_not_a_number_stops_the_wheels() -> None:
    world = one_robot()
    drive(world, Velocity(1.0, 0.0, 0.0), 20)
    world.robots["cyan1"].drive.command((math.nan, math.nan, math.nan), world.time_us)
    for _ in range(20):
        world.advance(TICK_US)
    assert world.robots["cyan1"].velocity == pytest.approx(STANDSTILL, abs=1e-3)


def test_robot_stays_inside_the_wall() -> None:
    world = one_robot(pose=Pose(9.0, 5.0, 0.0))
    drive(world, Velocity(3.0, 0.0, 0.0), 60)
    assert world.robots["cyan1"].body.position.x == pytest.approx(12.0 - 0.25, abs=0.01)

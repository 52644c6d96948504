"""Wheels, odometry and ramp: exact motions of a base on three omnidirectional wheels."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from procs.drivers.odometry import Odometry
from procs.drivers.ramp import Ramp, within_wheel_limit
from procs.model.kinematics import STANDSTILL, Velocity, velocity_of, wheels_of

SPEEDS = st.floats(-5.0, 5.0)
VELOCITIES = st.builds(Velocity, SPEEDS, SPEEDS, SPEEDS)


def ramp() -> Ramp:
    return Ramp(
        speed_m_s=3.0, acceleration_m_s2=2.0, braking_m_s2=4.0, omega_rad_s=6.0, angular_acceleration_rad_s2=10.0
    )


@given(VELOCITIES)
def test_velocity_is_the_inverse_of_wheels(velocity: Velocity) -> None:
    assert velocity_of(wheels_of(velocity, 0.2), 0.2) == pytest.approx(velocity, abs=1e-12)


def test_turning_on_the_spot_turns_every_wheel_forward() -> None:
    assert wheels_of(Velocity(0.0, 0.0, 2.0), 0.2) == pytest.approx((0.4, 0.4, 0.4))


def test_straight_ahead_rests_the_rear_wheel() -> None:
    first, second, third = wheels_of(Velocity(1.0, 0.0, 0.0), 0.2)
    assert (first, second, third) == pytest.approx((-math.sqrt(3) / 2, 0.0, math.sqrt(3) / 2))


def test_to_the_left_the_rear_wheel_turns_fastest() -> None:
    assert wheels_of(Velocity(0.0, 1.0, 0.0), 0.2) == pytest.approx((0.5, -1.0, 0.5))


def test_odometry_drives_a_full_circle_exactly() -> None:
    odometry = Odometry()
    for _ in range(40):
        odometry.advance(Velocity(1.0, 0.0, math.pi), 0.05)
    assert (odometry.x_m, odometry.y_m) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert odometry.heading_rad == pytest.approx(2 * math.pi)
    assert odometry.path_length_m == pytest.approx(2.0)


def test_odometry_in_one_step_equals_many() -> None:
    one, many = Odometry(), Odometry()
    one.advance(Velocity(1.0, -0.5, 0.8), 1.0)
    for _ in range(10):
        many.advance(Velocity(1.0, -0.5, 0.8), 0.1)
    assert (one.x_m, one.y_m) == pytest.approx((many.x_m, many.y_m))


def test_ramp_keeps_acceleration_and_braking_apart() -> None:
    limits = ramp()
    assert limits.advance(Velocity(3.0, 0.0, 0.0), 0.1).vx_m_s == pytest.approx(0.2)
    for _ in range(20):
        limits.advance(Velocity(9.0, 0.0, 0.0), 0.1)
    assert limits.velocity.vx_m_s == pytest.approx(3.0)
    assert limits.advance(STANDSTILL, 0.1).vx_m_s == pytest.approx(2.6)


@given(st.lists(VELOCITIES, min_size=1, max_size=20))
def test_ramp_never_changes_faster_than_its_limits(wanted: list[Velocity]) -> None:
    limits = ramp()
    for wish in wanted:
        before = limits.velocity
        after = limits.advance(wish, 0.05)
        turn_rad = (before.omega_rad_s + after.omega_rad_s) / 2 * 0.05
        over_ground = cmath.rect(1.0, turn_rad) * complex(after.vx_m_s, after.vy_m_s)
        change_m_s = abs(over_ground - complex(before.vx_m_s, before.vy_m_s))
        assert change_m_s <= 4.0 * 0.05 + 1e-9
        assert math.hypot(after.vx_m_s, after.vy_m_s) <= 3.0 + 1e-9
        assert abs(after.omega_rad_s - before.omega_rad_s) <= 10.0 * 0.05 + 1e-9


def test_invalid_command_brakes() -> None:
    limits = ramp()
    limits.advance(Velocity(1.0, 0.0, 0.0), 1.0)
    assert limits.advance(Velocity(math.nan, 0.0, math.inf), 1.0) == STANDSTILL


def test_motion_above_the_limit_is_slowed_as_a_whole() -> None:
    possible = within_wheel_limit(Velocity(3.0, 3.0, 6.0), 2.0, 0.2)
    assert max(map(abs, wheels_of(possible, 0.2))) == pytest.approx(2.0)
    assert possible.vx_m_s == pytest.approx(possible.vy_m_s)
    assert within_wheel_limit(Velocity(0.5, 0.0, 0.0), 2.0, 0.2) == Velocity(0.5, 0.0, 0.0)


def test_robot_that_turns_keeps_its_velocity_over_the_ground() -> None:
    """At 3 m/s and 4 rad/s the velocity in the robot's frame turns by 12 m/s2, which is no acceleration."""
    limits, heading_rad = ramp(), 0.0
    for _ in range(60):
        limits.advance(Velocity(3.0, 0.0, 0.0), 0.05)
    for _ in range(20):
        before_rad_s = limits.velocity.omega_rad_s
        turned_rad = min(4.0, before_rad_s + 10.0 * 0.05)
        heading_rad += (before_rad_s + turned_rad) / 2 * 0.05
        wanted = cmath.rect(3.0, -heading_rad)
        limits.advance(Velocity(wanted.real, wanted.imag, 4.0), 0.05)
        driven = cmath.rect(1.0, heading_rad) * complex(limits.velocity.vx_m_s, limits.velocity.vy_m_s)
        assert driven == pytest.approx(3.0 + 0.0j, abs=1e-9)

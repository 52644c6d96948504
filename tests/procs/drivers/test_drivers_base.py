"""The driver of the wheels: commands in, wheel speeds out, odometry from measured wheel speeds."""

import math
import re
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.core import log_t
from lcmtypes.robot import motor_command_t, wheel_state_t
from procs.drivers.base import Base
from procs.model.expected_errors import EXPECTED
from procs.model.kinematics import STANDSTILL, Velocity, velocity_of, wheels_of
from procs.model.realism import Realism
from procs.simulation.physics.realism import noise_of
from procs.simulation.physics.sensors import Encoders


def bench(**settings: Any) -> Bench:
    return Bench(Base, **settings)


def commanded(base: Bench) -> Velocity:
    first, second, third = base.port("wheel_command").sent[-1].wheel_m_s
    return velocity_of((first, second, third), 0.2)


def roll(base: Bench, velocity: Velocity, ticks: int) -> None:
    port = base.port("wheel_state")
    for _ in range(ticks):
        state = wheel_state_t()
        state.header.time_us = base.time_us + 50_000
        state.measured_m_s = list(wheels_of(velocity, 0.2))
        port.put(state)
        base.iterate(stage="sensor_acquire")


def drive(base: Bench, ticks: int, **command: Any) -> Velocity:
    for _ in range(ticks):
        message = motor_command_t()
        message.header.time_us = base.time_us
        base.port("motor_command").put(message, **command)
        base.iterate(stage="act_exec")
    return commanded(base)


def test_base_accelerates_within_its_limits() -> None:
    base = bench(acceleration_m_s2=2.0)
    assert drive(base, 1, vx_m_s=1.0, enabled=True).vx_m_s == pytest.approx(0.1)
    assert drive(base, 20, vx_m_s=1.0, enabled=True) == pytest.approx((1.0, 0.0, 0.0))


@pytest.mark.parametrize("every", [1, 2, 5, 20])
def test_acceleration_does_not_depend_on_the_ticks_between(every: int) -> None:
    base = bench(acceleration_m_s2=1.0, every=every)
    for _ in range(40):
        message = motor_command_t()
        message.header.time_us = base.time_us
        base.port("motor_command").put(message, vx_m_s=3.0, enabled=True)
        base.iterate()
    assert commanded(base).vx_m_s == pytest.approx(40 * 0.05 * 1.0)


def test_limits_change_during_the_run() -> None:
    base = bench(acceleration_m_s2=2.0)
    before = drive(base, 5, vx_m_s=2.0, enabled=True).vx_m_s
    base.component.config.acceleration_m_s2 = 1.0
    base.component.config_changed()
    assert drive(base, 1, vx_m_s=2.0, enabled=True).vx_m_s == pytest.approx(before + 0.05)


def test_wheel_commands_stay_within_the_limit() -> None:
    base = bench(robot={"wheel_limit_m_s": 2.0})
    drive(base, 60, vx_m_s=3.0, vy_m_s=1.0, omega_rad_s=0.5, enabled=True)
    assert max(map(abs, base.port("wheel_command").sent[-1].wheel_m_s)) == pytest.approx(2.0)


def test_base_with_slow_wheels_brakes_at_once() -> None:
    base = bench(robot={"wheel_limit_m_s": 1.5}, braking_m_s2=4.0)
    before = drive(base, 40, vx_m_s=3.0, enabled=True).vx_m_s
    assert before < 1.8
    assert drive(base, 1, enabled=True).vx_m_s == pytest.approx(before - 0.2)


def test_disabled_motors_brake() -> None:
    base = bench()
    drive(base, 40, vx_m_s=1.0, enabled=True)
    assert drive(base, 10, vx_m_s=1.0, enabled=False) == pytest.approx((0.0, 0.0, 0.0))


def test_silence_brakes_and_is_reported_once() -> None:
    base = bench(command_timeout_s=0.2)
    drive(base, 40, vx_m_s=1.0, enabled=True)
    base.iterate(3, stage="act_exec")
    assert commanded(base).vx_m_s == pytest.approx(1.0)
    base.iterate(10, stage="act_exec")
    assert commanded(base) == pytest.approx((0.0, 0.0, 0.0))
    assert [line.text for line in base.logged] == ["no motor command for 0.25 s: braking"]


def test_command_that_is_not_a_number_brakes() -> None:
    base = bench()
    drive(base, 40, vx_m_s=1.0, enabled=True)
    assert drive(base, 10, vx_m_s=math.nan, enabled=True) == pytest.approx((0.0, 0.0, 0.0))


def test_odometry_drives_a_quarter_circle() -> None:
    base = bench()
    roll(base, Velocity(1.0, 0.0, math.pi / 2), 20)
    odometry = base.port("odometry").sent[-1]
    assert (odometry.x_m, odometry.y_m) == pytest.approx((2 / math.pi, 2 / math.pi))
    assert (odometry.heading_rad, odometry.path_length_m) == pytest.approx((math.pi / 2, 1.0))
    assert (odometry.vx_m_s, odometry.omega_rad_s) == pytest.approx((1.0, math.pi / 2))


def test_late_measurement_counts_in_full() -> None:
    base = bench()
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    state = wheel_state_t()
    state.header.time_us = base.time_us + 50_000
    state.measured_m_s = list(wheels_of(Velocity(1.0, 0.0, 0.0), 0.2))
    base.port("wheel_state").put(state)
    base.iterate(stage="act_exec")
    base.iterate(stage="sensor_acquire")
    assert base.port("odometry").sent[-1].x_m == pytest.approx(0.1)


@pytest.mark.parametrize("stages", [("sensor_acquire",), ("act_exec", "sensor_acquire")])
def test_wheels_measured_often_in_a_tick_drive_no_further(stages: tuple[str, ...]) -> None:
    base = bench()
    for _ in range(10):
        for stage in stages:
            for speed_m_s in (0.5, 1.0, 1.5):
                state = wheel_state_t()
                state.header.time_us = base.time_us + 50_000
                state.measured_m_s = list(wheels_of(Velocity(speed_m_s, 0.0, 0.0), 0.2))
                base.port("wheel_state").put(state)
            base.iterate(stage=stage)
            base.time_us -= 50_000 * (stage == "act_exec")
    odometry = base.port("odometry").sent[-1]
    assert (odometry.x_m, odometry.path_length_m) == pytest.approx((0.5, 0.5))
    assert odometry.vx_m_s == pytest.approx(1.0)


def test_lost_measurement_is_bridged() -> None:
    base = bench()
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    base.iterate(2, stage="sensor_acquire")
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    assert base.port("odometry").sent[-1].x_m == pytest.approx(0.2)


@pytest.mark.parametrize("speed_m_s", [math.nan, math.inf, 1e300])
def test_impossible_wheel_speeds_are_refused_with_a_warning(speed_m_s: float) -> None:
    base = bench()
    base.port("wheel_state").put(measured_m_s=[0.0, speed_m_s, 0.0])
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    assert base.port("odometry").sent[-1].x_m == pytest.approx(0.05)
    assert base.logged[0].text == f"wheel speeds 0.0, {speed_m_s}, 0.0 m/s are impossible; ignored"


@pytest.mark.parametrize("measured_m_s", [[], [0.1, 0.2], [0.1, 0.2, 0.3, 0.4]])
def test_wrong_number_of_wheels_is_an_error_told_once(measured_m_s: list[float]) -> None:
    base = bench()
    for _ in range(3):
        base.port("wheel_state").put(measured_m_s=measured_m_s)
        base.iterate(stage="sensor_acquire")
    assert base.port("odometry").sent[-1].x_m == 0.0
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    assert base.port("odometry").sent[-1].vx_m_s == pytest.approx(1.0)
    assert [(line.level, line.text) for line in base.logged] == [
        (
            log_t.ERROR,
            f"wheel_state of an unknown writer has {len(measured_m_s)} wheel speeds; this robot has 3 wheels, at 60, "
            "180, 300 degrees from forward, and needs one speed for each, in this order; ignored",
        )
    ]


def test_each_wrong_number_of_wheels_is_told() -> None:
    base = bench()
    for number in (2, 4, 4):
        base.port("wheel_state").put(measured_m_s=[0.0] * number)
        base.iterate(stage="sensor_acquire")
    assert [line.text.partition(";")[0][-14:] for line in base.logged] == ["2 wheel speeds", "4 wheel speeds"]


def test_covariance_is_that_of_the_wheels_by_their_geometry() -> None:
    base = bench(wheel_scale_sd=0.03, wheel_noise_sqrt_s=0.01, wheel_resolution_m_s=0.002)
    base.iterate(stage="sensor_acquire")
    assert not np.any(base.port("odometry").sent[-1].velocity_covariance), (
        "nothing is known before the first measurement"
    )
    velocity = Velocity(1.0, 0.5, -2.0)
    roll(base, velocity, 1)
    relative = 0.03**2 + 0.01**2 / 0.05  # ticks of 50 ms
    variances_m2_s2 = relative * np.square(wheels_of(velocity, 0.2)) + 0.002**2
    by_wheel = np.array([velocity_of((float(a), float(b), float(c)), 0.2) for a, b, c in np.eye(3)]).T
    expected = by_wheel @ np.diag(variances_m2_s2) @ by_wheel.T
    assert np.allclose(base.port("odometry").sent[-1].velocity_covariance, expected, rtol=1e-12, atol=1e-18)


def test_covariance_covers_the_errors_of_simulated_encoders() -> None:
    velocity, errors, base = Velocity(1.0, -0.5, 1.0), [], bench()
    for seed in range(400):
        encoders = Encoders(noise_of("realistic", {}), np.random.default_rng(seed))
        base.port("wheel_state").put(measured_m_s=encoders.read(wheels_of(velocity, 0.2), 0.05))
        base.iterate(stage="sensor_acquire")
        odometry = base.port("odometry").sent[-1]
        errors.append(np.subtract((odometry.vx_m_s, odometry.vy_m_s, odometry.omega_rad_s), velocity))
    roll(base, velocity, 1)
    told = np.array(base.port("odometry").sent[-1].velocity_covariance)
    assert np.mean([error @ np.linalg.solve(told, error) for error in errors]) == pytest.approx(3.0, abs=0.4)


def test_standing_wheels_have_a_proper_covariance() -> None:
    base = bench()
    roll(base, STANDSTILL, 1)
    assert np.linalg.eigvalsh(base.port("odometry").sent[-1].velocity_covariance).min() > 1e-7


def test_impossible_wheel_speeds_leave_the_covariance() -> None:
    base = bench()
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    before = base.port("odometry").sent[-1].velocity_covariance
    base.port("wheel_state").put(measured_m_s=[math.nan, math.inf, 1e300])
    base.iterate(stage="sensor_acquire")
    assert base.port("odometry").sent[-1].velocity_covariance == before


@pytest.mark.parametrize("realism", ["none", "friendly", "realistic", "harsh"])
def test_expected_wheel_errors_are_those_of_the_simulation(realism: Realism) -> None:
    expected, noise = EXPECTED[realism], noise_of(realism, {})
    assert (expected.wheel_scale_sd, expected.wheel_noise_sqrt_s) == (noise.wheel_scale_sd, noise.wheel_noise_sqrt_s)


def test_covariance_grows_with_the_realism_of_the_wheels() -> None:
    variances = []
    for settings in ({"realism": "friendly"}, {}, {"realism": "harsh"}, {"realism": "harsh", "wheel_scale_sd": 0.5}):
        base = bench(**settings)
        roll(base, Velocity(1.0, 0.0, 0.0), 1)
        variances.append(base.port("odometry").sent[-1].velocity_covariance[0][0])
    assert variances == sorted(set(variances))


@pytest.mark.parametrize("name", ["wheel_scale_sd", "wheel_noise_sqrt_s", "wheel_resolution_m_s"])
@pytest.mark.parametrize("deviation", [-0.1, math.nan, math.inf])
def test_deviations_that_cannot_be_are_refused(name: str, deviation: float) -> None:
    with pytest.raises(ValueError, match=name):
        bench(**{name: deviation})


def test_after_a_long_silence_only_the_last_period_counts() -> None:
    base = bench()
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    base.iterate(100, stage="sensor_acquire")
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    assert base.port("odometry").sent[-1].x_m == pytest.approx(0.1)


@pytest.mark.parametrize("period_s", [0.05, 0.02, 0.1])
def test_odometry_of_silent_wheels_stands_after_half_a_second(period_s: float) -> None:
    base = bench(period_s=period_s)
    roll(base, Velocity(2.0, 0.0, 1.0), 5)
    heard_us = base.time_us
    for _ in range(100):
        base.iterate(stage="sensor_acquire")
        odometry = base.port("odometry").sent[-1]
        stands = base.time_us - heard_us > 500_000
        assert (odometry.vx_m_s, odometry.omega_rad_s) == ((0.0, 0.0) if stands else pytest.approx((2.0, 1.0)))
        assert np.any(odometry.velocity_covariance) != stands
    warnings = [line.text for line in base.logged]
    assert len(warnings) == 1
    assert re.fullmatch(r"no speeds of the wheels for 0\.[56]\d s: the robot counts as standing", warnings[0])
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    assert base.port("odometry").sent[-1].vx_m_s == pytest.approx(1.0)
    base.iterate(100, stage="sensor_acquire")
    assert len(base.logged) == 2, "a second silence is told, too"


def test_one_late_measurement_in_slow_ticks_is_no_silence() -> None:
    base = bench(period_s=0.8)
    roll(base, Velocity(1.0, 0.0, 0.0), 1)
    base.iterate(stage="sensor_acquire")
    assert base.port("odometry").sent[-1].vx_m_s == pytest.approx(1.0)
    assert base.logged == []


def test_base_that_begins_before_its_wheels_warns_of_nothing() -> None:
    base = bench()
    base.iterate(100, stage="sensor_acquire")
    assert base.logged == []


def test_base_leaves_the_wheels_stopped() -> None:
    base = bench()
    assert drive(base, 20, vx_m_s=1.0, enabled=True).vx_m_s == pytest.approx(1.0)
    base.finalize()
    assert tuple(base.port("wheel_command").sent[-1].wheel_m_s) == (0.0, 0.0, 0.0)

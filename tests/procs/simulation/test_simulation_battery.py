"""Batteries: what takes energy out, messages, empty ones, settings that cannot be."""

import math
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from fwk import Component, Reads
from fwk.testing import Bench, MemorySystem
from lcmtypes.robot import battery_state_t, kicker_drive_t, wheel_command_t
from lcmtypes.soccer import ball_placement_t
from procs.model.kinematics import Velocity, wheels_of
from procs.simulation.physics.battery import Battery
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.settings import BatterySettings
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World
from procs.simulation.simulator import Simulator

TICK_US = 40_000
FORWARD = [-0.866, 0.0, 0.866]


def bench(**settings: Any) -> Bench:
    return Bench(Simulator, name="world/simulator", namespaces=("cyan1", "cyan2"), **{"realism": "none", **settings})


def tick(world: Bench, times: int, **wheels: list[float]) -> None:
    for _ in range(times):
        for robot, wheel_m_s in wheels.items():
            command = wheel_command_t(wheel_m_s=wheel_m_s)
            command.header.time_us = world.time_us
            world.port("wheel_command", robot).put(command)
        world.iterate()


def used_j(seconds: int, speed_m_s: float = 0.0, turns_s: int = 0, kicks_s: int = 0) -> float:
    """Returns the energy that a robot takes besides idle power: it turns back and kicks every so many seconds."""
    world = World(["cyan1"], np.random.default_rng(1), starts={"cyan1": Pose(-8.0, 5.0, 0.0)})
    battery, settings = world.batteries["cyan1"], BatterySettings()
    for number in range(seconds * 25):
        sign = 1.0 if not turns_s or number // (turns_s * 25) % 2 == 0 else -1.0
        world.robots["cyan1"].drive.command(wheels_of(Velocity(sign * speed_m_s, 0.0, 0.0), 0.2), world.time_us)
        if kicks_s and number % (kicks_s * 25) == 0:
            world.kickers["cyan1"].command(KickerCommand(number + 1, 10.0, dribble=False), world.time_us)
        world.advance(TICK_US)
    return (1.0 - battery.charge) * settings.capacity_wh * 3600.0 - settings.idle_w * seconds


def test_battery_runs_down_by_its_idle_power() -> None:
    battery = Battery(BatterySettings(capacity_wh=10.0, idle_w=100.0, full_v=30.0, empty_v=20.0))
    assert (battery.charge, battery.voltage_v, battery.empty) == (1.0, 30.0, False)
    battery.drain(0.0, 0.0, 0.0, 180.0)
    assert (battery.charge, battery.voltage_v) == pytest.approx((0.5, 25.0))
    battery.drain(0.0, 0.0, 0.0, 1e6)
    assert (battery.charge, battery.voltage_v, battery.empty) == (0.0, 20.0, True)
    battery.refill()
    assert battery.charge == 1.0


def test_standing_robot_takes_idle_power_only() -> None:
    assert used_j(10) == pytest.approx(0.0, abs=1e-6)


def test_speeding_up_takes_the_energy_of_the_motion() -> None:
    settings = BatterySettings()
    motion_j = 35.0 * 1.0**2 / 2 / settings.drive_efficiency
    rolling_j = settings.rolling_resistance * 35.0 * 9.81 / 3 * 2 * 0.866 * 2.0 / settings.drive_efficiency
    assert motion_j + 0.8 * rolling_j < used_j(2, speed_m_s=1.0) < 2.0 * motion_j + rolling_j, (
        "wheels that spin lose some"
    )


def test_faster_driving_takes_more() -> None:
    assert 0.0 < used_j(4, 1.0, turns_s=1) < used_j(4, 2.0, turns_s=1)


def test_kick_takes_the_energy_of_the_ball() -> None:
    ball_j = 0.43 * 10.0**2 / 2
    assert used_j(4, kicks_s=2) == pytest.approx(2 * ball_j / BatterySettings().kick_efficiency)


def test_match_of_two_halves_does_not_empty_a_battery() -> None:
    """A lively robot in 45 minutes: two halves of 15 minutes, the break, and the stops in between."""
    settings = BatterySettings()
    lively_w = used_j(32, 2.0, turns_s=4, kicks_s=16) / 32
    assert 30.0 < lively_w < 150.0
    assert (settings.idle_w + lively_w) * 45 * 60 < 0.8 * settings.capacity_wh * 3600.0


def test_state_of_each_battery_is_told_once_a_second() -> None:
    world = bench()
    tick(world, 61, cyan1=FORWARD)  # of 50 ms
    driver, rests = (world.port("battery_state", robot).sent for robot in ("cyan1", "cyan2"))
    assert [sent.header.tick for sent in driver] == [sent.header.tick for sent in rests] == [1, 21, 41, 61]
    assert [sent.capture_us for sent in driver] == [sent.header.time_us for sent in driver]
    assert 0.999 < driver[-1].charge < rests[-1].charge < 1.0
    assert 29.0 < driver[-1].voltage_v < 29.4


def test_empty_battery_stops_its_robot_and_is_told_once() -> None:
    world = bench(physics={"battery": {"capacity_wh": 0.06, "idle_w": 100.0}}, starts={"cyan1": (-0.33, 0.0, 0.0)})
    tick(world, 20, cyan2=FORWARD)
    assert world.port("ground_truth").sent[-1].robots[1].vx_m_s == pytest.approx(1.0, abs=0.01)
    tick(world, 60, cyan2=FORWARD)
    drive = kicker_drive_t(kick_id=1, kick_m_s=8.0)
    drive.header.time_us = world.time_us
    world.port("kicker_drive", "cyan1").put(drive)
    tick(world, 2, cyan2=FORWARD)
    truth = world.port("ground_truth").sent[-1]
    assert math.hypot(truth.robots[1].vx_m_s, truth.robots[1].omega_rad_s) < 1e-3
    assert math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s) < 1e-3
    assert world.port("kicker_sensor", "cyan1").sent[-1].kick_id == 0
    assert sorted(line.text for line in world.logged) == [
        f"the battery of {robot} is empty: motors and kicker stop; world/reset puts a full one in"
        for robot in ("cyan1", "cyan2")
    ]
    assert world.port("battery_state", "cyan2").sent[-1].charge == 0.0


class Gauge(Component):
    """Reads the battery of its namespace."""

    stage = "think"
    battery_state: Reads[battery_state_t]

    def loop(self) -> None:
        pass


def test_namespace_without_wheels_has_no_battery() -> None:
    """As with `fwk-launch --without cyan1/base`: the rest of the robot still reads its battery."""
    system = MemorySystem(
        {"world/simulator": Simulator, "cyan1/gauge": Gauge, "cyan2/gauge": Gauge},
        outside={"cyan2/wheel_command": wheel_command_t, "world/ball_placement": ball_placement_t},
    )
    system.tick()
    assert not system.sent["cyan1/battery_state"]
    assert system.newest("cyan2/battery_state").charge > 0.9


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
@pytest.mark.parametrize("name", list(BatterySettings.model_fields))
def test_settings_that_cannot_be_are_refused(name: str, value: float) -> None:
    with pytest.raises(ValidationError, match=name):
        BatterySettings.model_validate({name: value})


def test_battery_with_swapped_voltages_is_refused() -> None:
    with pytest.raises(ValidationError, match=r"full_v is 20\.0 V, below empty_v of 24\.0 V; it should be above"):
        BatterySettings(full_v=20.0, empty_v=24.0)

"""The simulator as a component: channels, time, silent robots, the ball crew, and the same bytes every time."""

import hashlib
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fwk import Calls, Component, Reads, Writes
from fwk.testing import Bench, MemorySystem
from lcmtypes.robot import (
    dribble_command_t,
    imu_t,
    kick_command_t,
    kicker_drive_t,
    kicker_state_t,
    motor_command_t,
    odometry_t,
    wheel_command_t,
)
from lcmtypes.soccer import ball_placement_t, game_state_t, ground_truth_t, match_event_t, match_events_t
from procs.drivers.base import Base
from procs.drivers.kicker import Kicker
from procs.model.realism import Realism
from procs.referee.referee import Referee
from procs.simulation.physics.realism import noise_of
from procs.simulation.simulator import Simulator, SimulatorConfig

ROBOTS = ("cyan1", "cyan2", "magenta1")


def bench(**settings: Any) -> Bench:
    return Bench(Simulator, name="world/simulator", namespaces=ROBOTS, **{"realism": "none", **settings})


def tick(world: Bench, times: int = 1, **wheels: list[float]) -> ground_truth_t:
    """Advances time while robots are told to turn their wheels."""
    for _ in range(times):
        for robot, wheel_m_s in wheels.items():
            message = wheel_command_t()
            message.header.time_us = world.time_us
            message.wheel_m_s = wheel_m_s
            world.port("wheel_command", robot).put(message)
        world.iterate()
    truth: ground_truth_t = world.port("ground_truth").sent[-1]
    return truth


def events(world: Bench) -> list[match_event_t]:
    reports: list[match_events_t] = world.port("match_events").sent
    return [event for report in reports for event in report.events]


def test_robots_start_where_their_numbers_say() -> None:
    robots = {robot.name: robot for robot in tick(bench()).robots}
    assert list(robots) == ["cyan1", "cyan2", "magenta1"]
    assert robots["cyan1"].x_m < -10.0 < 10.0 < robots["magenta1"].x_m
    assert abs(robots["magenta1"].heading_rad) == pytest.approx(math.pi)


def test_settings_move_a_robot() -> None:
    truth = tick(bench(starts={"cyan2": (-1.0, 2.0, 0.5)}))
    assert (truth.robots[1].x_m, truth.robots[1].y_m, truth.robots[1].heading_rad) == pytest.approx((-1.0, 2.0, 0.5))


def test_start_of_a_robot_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ValueError, match=r"world/simulator: starts: no robot 'cyan7'; there are: cyan1, cyan2, mag"):
        bench(starts={"cyan7": (0.0, 0.0, 0.0)})


def test_simulator_sets_the_time_of_the_next_tick() -> None:
    for period_s, expected_us in ((0.05, 50_000), (0.02, 20_000)):
        system = MemorySystem({"world/simulator": Simulator, "world/referee": Referee}, period_s=period_s)
        system.tick()
        began_us = system.now_us
        system.tick()
        assert system.now_us == began_us + expected_us


def test_stuck_wheel_lames_its_robot_and_comes_free() -> None:
    world, forward = bench(stuck_wheels={"cyan1": [1]}), [-0.866, 0.0, 0.866]
    truth = tick(world, 20, cyan1=forward, cyan2=forward)
    lame, sound = truth.robots[0], truth.robots[1]
    assert sound.vx_m_s == pytest.approx(1.0, abs=0.01)
    assert lame.vx_m_s < 0.7
    assert abs(lame.omega_rad_s) > 0.5
    assert world.port("wheel_state", "cyan1").sent[-1].measured_m_s[0] == 0.0
    world.component.config.stuck_wheels = {}
    world.component.config_changed()
    assert abs(tick(world, 20, cyan1=forward).robots[0].omega_rad_s) < 0.05


def test_silent_imu_sends_nothing_and_changes_no_other_sensor() -> None:
    world, sound = bench(silent_imus=["cyan1"]), bench()
    for each in (world, sound):
        tick(each, 5)
    assert [len(each.port("imu", "cyan1").sent) for each in (world, sound)] == [0, 5]
    others = [each.port("imu", "cyan2").sent[-1].heading_rad for each in (world, sound)]
    assert others[0] == others[1]
    world.component.config.silent_imus = []
    tick(world, 1)
    assert len(world.port("imu", "cyan1").sent) == 1


def test_fault_of_a_robot_that_is_not_there_is_named() -> None:
    with pytest.raises(ValueError, match="silent_imus: no robot 'cyan9'; there are: cyan1, cyan2, magenta1"):
        bench(silent_imus=["cyan9"])
    with pytest.raises(ValueError, match="stuck_wheels: no robot 'cyan9'; there are: cyan1, cyan2, magenta1"):
        bench(stuck_wheels={"cyan9": [1]})
    with pytest.raises(ValueError, match="stuck_wheels"):
        bench(stuck_wheels={"cyan1": [4]})


def test_two_robots_with_one_number_are_refused() -> None:
    players = {name: {"team": "cyan", "number": number} for name, number in (("cyan1", 2), ("cyan2", 2), ("anna", 2))}
    with pytest.raises(ValueError, match="players: cyan1 and cyan2 are both cyan 2"):
        bench(players=players)


def test_settings_of_the_finished_world_are_fixed() -> None:
    live = {name for name, field in SimulatorConfig.model_fields.items() if not field.frozen}
    assert live - {"log_level"} == {"command_timeout_s", "silent_imus", "stuck_wheels"}


@pytest.mark.parametrize(("period_s", "timeout_s"), [(0.05, 0.25), (0.05, 1e-9), (0.5, 0.25)])
def test_robot_obeys_the_previous_tick_and_stops_when_silent(period_s: float, timeout_s: float) -> None:
    world = bench(period_s=period_s, command_timeout_s=timeout_s)
    assert tick(world, 20, cyan1=[0.2, 0.2, 0.2]).robots[0].omega_rad_s == pytest.approx(1.0, abs=0.05)
    assert tick(world, 20).robots[0].omega_rad_s == pytest.approx(0.0, abs=0.01)


def test_wheels_turn_and_are_measured() -> None:
    world = bench()
    truth = tick(world, 20, cyan1=[-0.866, 0.0, 0.866])
    assert truth.robots[0].vx_m_s == pytest.approx(1.0, abs=0.01)
    assert truth.robots[1].vx_m_s == 0.0
    assert world.port("wheel_state", "cyan1").sent[-1].measured_m_s == pytest.approx([-0.866, 0.0, 0.866], abs=1e-3)


@pytest.mark.parametrize("wheel_m_s", [[], [1.0], [1.0, 1.0, 1.0, 1.0]])
def test_command_for_another_number_of_wheels_stops(wheel_m_s: list[float]) -> None:
    world = bench()
    tick(world, 20, cyan1=[-0.866, 0.0, 0.866])
    assert tick(world, 20, cyan1=wheel_m_s).robots[0].vx_m_s == pytest.approx(0.0, abs=1e-3)
    assert [line.text for line in world.logged] == [
        f"cyan1/wheel_command of an unknown writer has {len(wheel_m_s)} wheel speeds; this robot has 3 wheels, at 60, "
        "180, 300 degrees from forward, and needs one speed for each, in this order; cyan1 stops"
    ]
    assert tick(world, 20, cyan1=[-0.866, 0.0, 0.866]).robots[0].vx_m_s == pytest.approx(1.0, abs=0.01)


def test_robot_that_receives_nothing_stops() -> None:
    world = bench()
    tick(world, 20, cyan1=[-0.866, 0.0, 0.866])
    assert tick(world, 4).robots[0].vx_m_s == pytest.approx(1.0, abs=0.01)
    assert tick(world, 20).robots[0].vx_m_s == pytest.approx(0.0, abs=1e-3)


def test_robot_that_receives_nothing_stops_handling_the_ball() -> None:
    world = bench(starts={"cyan1": (-0.33, 0.0, 0.0)})
    drive = kicker_drive_t()
    drive.dribble = True
    world.port("kicker_drive", "cyan1").put(drive)
    world.iterate(4)
    assert events(world)[-1].robot == "cyan1"
    world.iterate(4)
    before = len(events(world))
    world.iterate(4)
    assert len(events(world)) == before


def test_imu_reports_heading_and_yaw_rate() -> None:
    world = bench()
    truth = tick(world, 40, cyan1=[0.4, 0.4, 0.4])
    imu = world.port("imu", "cyan1").sent[-1]
    assert imu.heading_rad == pytest.approx(truth.robots[0].heading_rad)
    assert imu.yaw_rate_rad_s == pytest.approx(2.0, abs=0.01)


def test_kick_moves_the_ball_and_is_reported() -> None:
    world = bench(starts={"magenta1": (0.33, 0.0, math.pi)})
    drive = kicker_drive_t()
    drive.kick_id, drive.kick_m_s = 1, 6.0
    world.iterate()
    assert world.port("kicker_sensor", "magenta1").sent[-1].ball_held
    world.port("kicker_drive", "magenta1").put(drive)
    world.iterate()
    assert world.port("ground_truth").sent[-1].ball_vx_m_s == pytest.approx(-6.0, abs=0.2)
    sensor = world.port("kicker_sensor", "magenta1").sent[-1]
    assert (sensor.ball_held, sensor.charged, sensor.kick_id) == (False, False, 1)
    kicks = [event for event in events(world) if event.kind == match_event_t.KICK]
    assert [(kick.robot, kick.team) for kick in kicks] == [("magenta1", game_state_t.TEAM_MAGENTA)]


def test_goal_is_reported_without_a_team() -> None:
    """The referee knows which team attacks the goal in this half."""
    world = bench(starts={"cyan1": (-0.33, 0.0, 0.0), "magenta1": (5.0, 5.0, 0.0)})
    drive = kicker_drive_t()
    drive.kick_id, drive.kick_m_s = 1, 10.0
    world.port("kicker_drive", "cyan1").put(drive)
    world.iterate(40)
    goals = [event for event in events(world) if event.kind == match_event_t.GOAL]
    assert [(goal.robot, goal.team) for goal in goals] == [("cyan1", game_state_t.TEAM_NONE)]
    assert not world.port("match_events").sent[-1].ball_in_field
    assert world.port("match_events").sent[-1].last_touch == "cyan1"


def test_referee_placement_happens_once_for_each_number() -> None:
    world = bench()
    world.port("ball_placement").put(placement_id=1, x_m=3.0, y_m=-2.0)
    truth = tick(world)
    assert (truth.ball_x_m, truth.ball_y_m) == (3.0, -2.0)
    world.port("ball_placement").put(placement_id=1, x_m=0.0, y_m=0.0)
    assert tick(world).ball_x_m == 3.0
    world.port("ball_placement").put(placement_id=2, x_m=99.0, y_m=0.0)
    assert tick(world).ball_x_m == pytest.approx(11.89)


def test_impossible_placement_is_refused_with_a_warning() -> None:
    world = bench()
    world.port("ball_placement").put(placement_id=1, x_m=math.nan, y_m=0.0)
    assert tick(world).ball_x_m == 0.0
    assert [line.text for line in world.logged] == ["ball placement 1 asks for (nan, 0.0); ignored"]


@pytest.mark.parametrize(("realism", "period_s"), [("none", 0.05), ("realistic", 0.05), ("harsh", 0.02)])
def test_compass_and_gyro_tell_their_deviations(realism: Realism, period_s: float) -> None:
    world, noise = bench(realism=realism, period_s=period_s), noise_of(realism, {})
    tick(world)
    imu = world.port("imu", "cyan1").sent[-1]
    assert imu.heading_sd_rad == pytest.approx(noise.compass_noise_sqrt_s / math.sqrt(period_s))
    assert imu.yaw_rate_sd_rad_s == pytest.approx(noise.gyro_noise_sqrt_s / math.sqrt(period_s))
    assert imu.acceleration_sd_m_s2 == 0.0, "the simulated accelerometer has no error"


def test_deviations_cover_the_noise_of_compass_and_gyro() -> None:
    world = bench(realism="realistic", errors={"compass_drift_sd_rad": 0.0, "gyro_bias_sd_rad_s": 0.0})
    tick(world, 400)
    sent = world.port("imu", "cyan2").sent
    assert np.std([imu.heading_rad for imu in sent]) == pytest.approx(sent[-1].heading_sd_rad, rel=0.1)
    assert np.std([imu.yaw_rate_rad_s for imu in sent]) == pytest.approx(sent[-1].yaw_rate_sd_rad_s, rel=0.1)


def test_realism_makes_odometry_drift_from_the_truth() -> None:
    ideal, real = bench(), bench(realism="realistic")
    for world in (ideal, real):
        tick(world, 20, cyan1=[-0.866, 0.0, 0.866])
    assert np.std([state.measured_m_s[2] for state in ideal.port("wheel_state", "cyan1").sent[-5:]]) < 1e-3
    assert np.std([state.measured_m_s[2] for state in real.port("wheel_state", "cyan1").sent[-5:]]) > 1e-3


class Wanderer(Component):
    """Drives and kicks at random, and receives everything."""

    stage = "think"
    rng: np.random.Generator
    imu: Reads[imu_t]
    odometry: Reads[odometry_t]
    kicker_state: Reads[kicker_state_t]
    motor_command: Writes[motor_command_t]
    kick: Calls[kick_command_t]
    dribble_command: Writes[dribble_command_t]

    def loop(self) -> None:
        motor, dribble = self.motor_command.value, self.dribble_command.value
        motor.enabled, dribble.on = True, True
        if self.odometry.header.tick % 20 == 1:
            motor.vx_m_s, motor.omega_rad_s = self.rng.uniform(0.0, 2.5), self.rng.uniform(-1.5, 1.5)
        if self.rng.integers(2):
            self.kick.value.speed_m_s = 8.0
            self.kick.call(expires_s=0.0)
        self.motor_command.write()
        self.dribble_command.write()


class Crew(Component):
    """Puts the ball before one of the robots every two seconds."""

    stage = "post_loop"
    rng: np.random.Generator
    ground_truth: Reads[ground_truth_t]
    ball_placement: Writes[ball_placement_t]

    def loop(self) -> None:
        truth, placement = self.ground_truth.value, self.ball_placement.value
        if self.ground_truth.header.tick % 40 == 1:
            robot = truth.robots[self.rng.integers(truth.n)]
            placement.placement_id += 1
            placement.x_m = robot.x_m + 0.35 * math.cos(robot.heading_rad)
            placement.y_m = robot.y_m + 0.35 * math.sin(robot.heading_rad)
            self.ball_placement.write()


def wandering_robots(ticks: int, robots: int = 5) -> MemorySystem:
    """Returns two teams of wanderers."""
    components: dict[str, type[Component]] = {"world/simulator": Simulator, "world/crew": Crew}
    for team in ("cyan", "magenta"):
        for number in range(1, robots + 1):
            robot = f"{team}{number}"
            components |= {f"{robot}/base": Base, f"{robot}/kicker": Kicker, f"{robot}/player": Wanderer}
    system = MemorySystem(components, seed=7)
    system.tick(ticks)
    return system


def digest(system: MemorySystem) -> str:
    """Returns a digest of all bytes sent on any channel."""
    total = hashlib.sha256()
    for name, sent in sorted(system.sent.items()):
        for message in sent:
            total.update(name.encode() + message)
    return total.hexdigest()


@pytest.mark.slow
def test_ten_robots_wander_and_touch_the_ball_and_each_other() -> None:
    system = wandering_robots(200)
    kinds = set()
    for data in system.sent["world/match_events"]:
        kinds |= {event.kind for event in match_events_t.decode(data).events}
    assert {match_event_t.TOUCH, match_event_t.COLLISION, match_event_t.KICK} <= kinds
    assert system.now_us == 200 * 50_000


@pytest.mark.slow
def test_fresh_processes_send_the_same_bytes() -> None:
    here = Path(__file__)
    code = (
        f"import sys; sys.path.insert(0, {str(here.parent)!r}); "
        f"import {here.stem} as t; print(t.digest(t.wandering_robots(120)))"
    )
    digests = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            cwd=here.parents[2],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("0", "4242")
    }
    assert len(digests) == 1
    assert digests == {digest(wandering_robots(120)) + "\n"}

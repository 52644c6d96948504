"""Commands to the simulator: robots and ball are put down, the world stands still and begins anew."""

import math
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.core import answer_t
from lcmtypes.robot import wheel_command_t
from procs.simulation.simulator import Simulator

ROBOTS = ("cyan1", "magenta1")


def bench(**settings: Any) -> Bench:
    return Bench(Simulator, name="world/simulator", namespaces=ROBOTS, realism="none", **settings)


def test_robot_is_set_down_elsewhere() -> None:
    world = bench()
    world.port("place_robot").put(robot="magenta1", x_m=1.0, y_m=-2.0, heading_rad=0.5)
    world.iterate()
    robot = world.port("ground_truth").sent[-1].robots[1]
    assert (robot.x_m, robot.y_m, robot.heading_rad) == pytest.approx((1.0, -2.0, 0.5))
    assert world.port("place_robot").sent[-1].answer.state == answer_t.DONE


@pytest.mark.parametrize("x_m", [4.0, 4.1, 3.8])
def test_robot_on_the_ball_pushes_it_aside(x_m: float) -> None:
    world = bench()
    world.port("place_ball").put(x_m=4.0, y_m=3.0)
    world.iterate()
    world.port("place_robot").put(robot="cyan1", x_m=x_m, y_m=3.0)
    world.iterate()
    truth = world.port("ground_truth").sent[-1]
    robot = truth.robots[0]
    assert math.dist((robot.x_m, robot.y_m), (truth.ball_x_m, truth.ball_y_m)) > 0.36
    assert math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s) < 0.1


@pytest.mark.parametrize(
    ("ball", "robot"),
    [
        ((10.95, 0.3), (10.7, 0.3)),
        ((-10.95, 0.3), (-10.8, 0.4)),
        ((4.0, 6.95), (4.0, 6.8)),
        ((10.95, 3.0), (10.8, 3.0)),
    ],
)
def test_robot_on_the_ball_pushes_it_over_no_line(ball: tuple[float, float], robot: tuple[float, float]) -> None:
    """Setting a robot down neither scores a goal nor gives a throw-in."""
    world = bench()
    world.port("place_ball").put(x_m=ball[0], y_m=ball[1])
    world.iterate(2)
    world.port("place_robot").put(robot="cyan1", x_m=robot[0], y_m=robot[1])
    world.iterate(3)
    assert [event for report in world.port("match_events").sent for event in report.events] == []
    assert world.port("match_events").sent[-1].ball_in_field
    truth = world.port("ground_truth").sent[-1]
    assert math.dist(robot, (truth.ball_x_m, truth.ball_y_m)) > 0.36


@pytest.mark.parametrize(("z_m", "stays"), [(0.02, False), (0.3, False), (0.9, True)])
def test_robot_set_down_on_a_flying_ball_scores_no_goal(z_m: float, stays: bool) -> None:
    """A ball above the robot flies on."""
    world = bench()
    world.port("place_ball").put(x_m=10.95, y_m=0.3, z_m=z_m, vz_m_s=1.0)
    world.iterate()
    world.port("place_robot").put(robot="cyan1", x_m=10.7, y_m=0.3)
    world.iterate()
    assert [event for report in world.port("match_events").sent for event in report.events] == []
    truth = world.port("ground_truth").sent[-1]
    assert (math.dist((10.7, 0.3), (truth.ball_x_m, truth.ball_y_m)) < 0.36) is stays


@pytest.mark.parametrize("heading_rad", [7.0, -1e6, 1e17, -1e30])
def test_robot_that_is_set_down_with_many_turns_can_turn(heading_rad: float) -> None:
    world = bench()
    world.port("place_robot").put(robot="cyan1", x_m=1.0, y_m=-2.0, heading_rad=heading_rad)
    world.iterate()
    before_rad = world.port("ground_truth").sent[-1].robots[0].heading_rad
    assert before_rad == pytest.approx(math.remainder(heading_rad, math.tau), abs=1e-6)
    for _ in range(10):
        command = wheel_command_t(wheel_m_s=[0.2, 0.2, 0.2])
        command.header.time_us = world.time_us
        world.port("wheel_command", "cyan1").put(command)
        world.iterate()
    robot = world.port("ground_truth").sent[-1].robots[0]
    assert math.remainder(robot.heading_rad - before_rad, math.tau) == pytest.approx(0.45, abs=0.1)
    assert robot.omega_rad_s == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize(
    ("bearing_rad", "distance_m", "stays"),
    [(0.0, 0.33, True), (0.0, 0.3, False), (0.0, 0.22, False), (math.pi, 0.37, True), (math.pi, 0.34, False)],
)
def test_robot_overlaps_no_ball_at_its_hull(bearing_rad: float, distance_m: float, stays: bool) -> None:
    """A ball in the mouth may stay there, as close as the flat front lets it."""
    world = bench()
    world.port("place_ball").put(x_m=4.0, y_m=3.0)
    world.iterate()
    x_m, y_m = 4.0 - distance_m * math.cos(bearing_rad), 3.0 - distance_m * math.sin(bearing_rad)
    world.port("place_robot").put(robot="cyan1", x_m=x_m, y_m=y_m)
    world.iterate()
    truth = world.port("ground_truth").sent[-1]
    at_m = (truth.ball_x_m, truth.ball_y_m)
    if stays:
        assert at_m == pytest.approx((4.0, 3.0), abs=1e-3)
    else:
        assert math.dist(at_m, (x_m, y_m)) > 0.36
    assert (truth.robots[0].x_m, truth.robots[0].y_m) == pytest.approx((x_m, y_m), abs=1e-3)


def test_ball_is_thrown() -> None:
    world = bench()
    world.port("place_ball").put(x_m=2.0, z_m=0.5, vx_m_s=3.0, vz_m_s=2.0)
    world.iterate()
    truth = world.port("ground_truth").sent[-1]
    assert truth.ball_x_m == pytest.approx(2.15)
    assert truth.ball_z_m == pytest.approx(0.5 + 0.1 - 9.81 * 0.05**2 / 2, abs=0.01)


@pytest.mark.parametrize(
    ("port", "values", "reason"),
    [
        ("place_robot", {"robot": "cyan7"}, "no robot 'cyan7'; there are: cyan1, magenta1"),
        ("place_robot", {"robot": "cyan1", "x_m": 13.0}, "(13, 0) is outside the walls; x is at most 12 m, y 8 m"),
        ("place_robot", {"robot": "cyan1", "heading_rad": math.nan}, "heading_rad is nan; it should be a number"),
        ("place_robot", {"robot": "cyan1", "heading_rad": -math.inf}, "heading_rad is -inf; it should be a number"),
        ("place_ball", {"y_m": math.inf}, "(0, inf) is outside the walls; x is at most 12 m, y 8 m"),
        ("place_ball", {"vx_m_s": 99.0}, "vx_m_s is 99.0; it should be from -15 to 15"),
        ("place_ball", {"vz_m_s": -99.0}, "vz_m_s is -99.0; it should be from -15 to 15"),
        ("place_ball", {"z_m": -0.5}, "z_m is -0.5; it should be from 0 to 5"),
        ("place_ball", {"z_m": math.nan}, "z_m is nan; it should be from 0 to 5"),
    ],
)
def test_impossible_place_is_refused(port: str, values: dict[str, object], reason: str) -> None:
    world = bench()
    world.port(port).put(**values)
    world.iterate()
    answer = world.port(port).sent[-1].answer
    assert (answer.state, answer.reason) == (answer_t.REJECTED, reason)


def test_frozen_world_stands_still_and_continues() -> None:
    world = bench()
    world.port("place_ball").put(vx_m_s=2.0)
    world.iterate()
    world.port("freeze").put(frozen=True)
    places = []
    for _ in range(5):
        command = wheel_command_t()
        command.header.time_us, command.wheel_m_s = world.time_us, [1.0, 1.0, 1.0]
        world.port("wheel_command", "cyan1").put(command)
        world.iterate()
        places.append(world.port("ground_truth").sent[-1].ball_x_m)
        assert not any(world.port("wheel_state", "cyan1").sent[-1].measured_m_s)
    assert len(set(places)) == 1
    truth, report = world.port("ground_truth").sent[-1], world.port("match_events").sent[-1]
    assert (truth.ball_vx_m_s, report.ball_speed_m_s, truth.robots[0].omega_rad_s) == (0.0, 0.0, 0.0)
    world.port("freeze").put(frozen=False)
    world.iterate()
    assert world.port("ground_truth").sent[-1].ball_x_m == pytest.approx(places[-1] + 0.09, abs=0.02)


def test_frozen_world_takes_nothing_out_of_batteries() -> None:
    world = bench()
    world.port("freeze").put(frozen=True)
    world.iterate(100)
    assert {sent.charge for sent in world.port("battery_state", "cyan1").sent} == {1.0}
    world.port("freeze").put(frozen=False)
    world.iterate(21)
    assert world.port("battery_state", "cyan1").sent[-1].charge < 1.0


def test_reset_puts_full_batteries_in() -> None:
    world = bench(physics={"battery": {"capacity_wh": 0.01}})
    world.iterate(30)
    assert world.port("battery_state", "cyan1").sent[-1].charge == 0.0
    world.port("reset").put()
    world.iterate()
    command = wheel_command_t(wheel_m_s=[0.1, 0.1, 0.1])
    command.header.time_us = world.time_us
    world.port("wheel_command", "cyan1").put(command)
    world.iterate(3)
    assert world.port("ground_truth").sent[-1].robots[0].omega_rad_s > 0.1


def test_reset_takes_robots_and_ball_back() -> None:
    world = bench()
    world.iterate()
    before = world.port("ground_truth").sent[-1].robots[0].x_m
    world.port("place_robot").put(robot="cyan1", x_m=3.0)
    world.port("place_ball").put(x_m=4.0)
    world.iterate()
    world.port("reset").put(keep_ball=True)
    world.iterate()
    truth = world.port("ground_truth").sent[-1]
    assert (truth.robots[0].x_m, truth.ball_x_m) == pytest.approx((before, 4.0))
    world.port("reset").put()
    world.iterate()
    assert world.port("ground_truth").sent[-1].ball_x_m == 0.0


@pytest.mark.parametrize("frozen", [False, True])
@pytest.mark.parametrize(("command", "values"), [("place_robot", {"robot": "cyan1", "x_m": -4.0}), ("reset", {})])
def test_robot_that_is_set_down_stays_there(command: str, values: dict[str, object], frozen: bool) -> None:
    """Its wheels turned before, and commands were on their way to its motors."""
    world = bench(errors={"drive_delay_s": 0.12})
    for _ in range(20):
        drive = wheel_command_t(wheel_m_s=[-2.0, 0.0, 2.0])
        drive.header.time_us = world.time_us
        world.port("wheel_command", "cyan1").put(drive)
        world.iterate()
    world.port("freeze").put(frozen=frozen)
    world.iterate(8)  # the last command gets too old
    world.port("wheel_command", "cyan1").put(drive)
    world.port(command).put(**values)
    world.iterate()
    before = world.port("ground_truth").sent[-1].robots[0]
    world.port("freeze").put(frozen=False)
    world.iterate(10)
    robot = world.port("ground_truth").sent[-1].robots[0]
    assert math.dist((robot.x_m, robot.y_m), (before.x_m, before.y_m)) < 1e-6


@pytest.mark.parametrize("frozen", [False, True])
@pytest.mark.parametrize(("command", "values"), [("place_robot", {"robot": "cyan1", "x_m": -4.0}), ("reset", {})])
def test_robot_does_not_feel_that_it_is_put_down(command: str, values: dict[str, object], frozen: bool) -> None:
    world = bench()
    for _ in range(30):
        drive = wheel_command_t(wheel_m_s=[-2.0, 0.0, 2.0])
        drive.header.time_us = world.time_us
        world.port("wheel_command", "cyan1").put(drive)
        world.iterate()
    assert world.port("ground_truth").sent[-1].robots[0].vx_m_s > 2.0
    world.port("freeze").put(frozen=frozen)
    world.iterate(8 if frozen else 0)
    world.port(command).put(**values)
    world.iterate()
    felt = world.port("imu", "cyan1").sent[-1]
    robot = world.port("ground_truth").sent[-1].robots[0]
    assert (felt.ax_m_s2, felt.ay_m_s2) == pytest.approx((robot.vx_m_s / 0.05, robot.vy_m_s / 0.05), abs=1e-9)
    assert abs(felt.ax_m_s2) < 10.0

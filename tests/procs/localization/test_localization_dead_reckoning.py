"""Turns of a robot whose wheels or gyro are silent for a while."""

import numpy as np

from fwk.testing import Bench
from procs.localization.localization import Localization
from tests.procs.localization.localization_parts import FakeRobot, frames


def standing() -> tuple[Bench, FakeRobot]:
    """Returns a robot that knows its place and stands."""
    robot = FakeRobot(seed=3)
    robot.pose = np.array((2.0, 1.0, 0.5))
    bench = Bench(Localization, start_x_m=2.0, start_y_m=1.0, start_heading_rad=0.5)
    assert all(frames(bench, robot, 20))
    return bench, robot


def turn(bench: Bench, robot: FakeRobot, turning_rad_s: float, count: int, silent: tuple[str, ...] = ()) -> None:
    """Turns for `count` ticks; the ports `silent` get no message."""
    for _ in range(count):
        robot.drive(np.array((0.0, 0.0, turning_rad_s)))
        robot.show(bench)
        for port in silent:
            bench.port(port).waiting.clear()
        bench.iterate()


def test_gyro_tells_of_turns_while_odometry_is_silent() -> None:
    bench, robot = standing()
    turn(bench, robot, 3.0, 10)
    turn(bench, robot, 3.0, 20, ("odometry", "line_points"))
    assert abs(robot.error(bench)[2]) < 0.05


def test_odometry_that_comes_back_turns_no_robot() -> None:
    """The base dies while the robot turns: its wheels stop soon, and the new base begins at zero 2 s later."""
    bench, robot = standing()
    turn(bench, robot, 3.0, 10)
    turn(bench, robot, 3.0, 5, ("odometry",))
    turn(bench, robot, 0.0, 40, ("odometry",))
    robot.odometry = np.zeros(3)
    for _ in range(5):
        assert all(frames(bench, robot, 1))
        assert abs(robot.error(bench)[2]) < 0.05


def test_gyro_that_comes_back_tells_of_no_turn_long_ago() -> None:
    bench, robot = standing()
    turn(bench, robot, 6.0, 10)
    turn(bench, robot, 0.0, 20, ("imu",))
    turn(bench, robot, 0.0, 1, ("line_points",))
    assert abs(robot.error(bench)[2]) < 0.03


def test_wheels_tell_the_turn_while_both_were_silent() -> None:
    bench, robot = standing()
    turn(bench, robot, 2.0, 10)
    turn(bench, robot, 2.0, 20, ("odometry", "imu", "line_points"))
    turn(bench, robot, 0.0, 1, ("line_points",))
    assert abs(robot.error(bench)[2]) < 0.1


def test_gyro_alone_tells_of_no_turn_while_it_was_silent() -> None:
    bench, robot = standing()
    turn(bench, robot, 0.0, 20, ("odometry", "imu"))
    turn(bench, robot, 2.0, 5, ("odometry", "line_points"))
    assert abs(robot.error(bench)[2]) < 0.05
    turn(bench, robot, 2.0, 1, ("line_points",))
    assert abs(robot.error(bench)[2]) < 0.1

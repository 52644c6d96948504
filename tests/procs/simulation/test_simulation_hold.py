"""A robot that is held: its motors and its kicker stand until it is let go."""

from fwk.testing import Bench
from lcmtypes.core import answer_t
from lcmtypes.robot import wheel_command_t
from procs.simulation.simulator import Simulator


def bench() -> Bench:
    return Bench(Simulator, name="world/simulator", namespaces=("cyan1", "magenta1"), realism="none")


def way_m(world: Bench, ticks: int = 10) -> float:
    """Drives cyan1 ahead and returns how far it comes."""
    before = world.port("ground_truth").sent[-1].robots[0].x_m
    for _ in range(ticks):
        command = wheel_command_t(wheel_m_s=[-1.0, 0.0, 1.0])
        command.header.time_us = world.time_us
        world.port("wheel_command", "cyan1").put(command)
        world.iterate()
    return abs(float(world.port("ground_truth").sent[-1].robots[0].x_m - before))


def hold(world: Bench, robot: str, held: bool) -> answer_t:
    world.port("hold_robot").put(robot=robot, held=held)
    world.iterate()
    answer: answer_t = world.port("hold_robot").sent[-1].answer
    return answer


def test_held_robot_stands_until_it_is_let_go() -> None:
    world = bench()
    assert hold(world, "cyan1", True).state == answer_t.DONE
    assert way_m(world) == 0.0
    hold(world, "magenta1", False)
    assert way_m(world) == 0.0
    hold(world, "cyan1", False)
    assert way_m(world) > 0.1


def test_reset_lets_all_robots_go() -> None:
    world = bench()
    hold(world, "cyan1", True)
    world.port("reset").put()
    world.iterate()
    assert way_m(world) > 0.1


def test_stranger_cannot_be_held() -> None:
    answer = hold(bench(), "cyan9", True)
    assert (answer.state, answer.reason) == (answer_t.REJECTED, "no robot 'cyan9'; there are: cyan1, magenta1")

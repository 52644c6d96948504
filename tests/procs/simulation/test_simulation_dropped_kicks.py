"""Kicks on their way are dropped when their robot is held or put down, or has an empty battery."""

from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.robot import kicker_drive_t, kicker_sensor_t
from procs.simulation.simulator import Simulator

KICK_DELAY_S = 0.3  # six ticks


def with_kick_under_way(**settings: Any) -> Bench:
    """Returns a world in which the kickers of both robots have just been told to kick."""
    errors = {"kick_delay_s": KICK_DELAY_S}
    robots = ("cyan1", "magenta1")
    world = Bench(Simulator, name="world/simulator", namespaces=robots, realism="none", errors=errors, **settings)
    world.iterate()
    kick(world, 1)
    return world


def kick(world: Bench, kick_id: int) -> None:
    for robot in ("cyan1", "magenta1"):
        drive = kicker_drive_t(kick_id=kick_id, kick_m_s=5.0)
        drive.header.time_us = world.time_us
        world.port("kicker_drive", robot).put(drive)
    world.iterate()


def sensor(world: Bench, robot: str) -> kicker_sensor_t:
    newest: kicker_sensor_t = world.port("kicker_sensor", robot).sent[-1]
    return newest


@pytest.mark.parametrize(
    ("command", "values"),
    [("hold_robot", {"robot": "cyan1", "held": True}), ("place_robot", {"robot": "cyan1", "x_m": 1.0})],
)
def test_kick_of_a_robot_held_or_put_down_is_dropped(command: str, values: dict[str, object]) -> None:
    world = with_kick_under_way()
    world.port(command).put(**values)
    world.iterate(20)
    assert [sensor(world, robot).kick_id for robot in ("cyan1", "magenta1")] == [0, 1]


def test_robot_that_is_let_go_keeps_its_kick() -> None:
    world = with_kick_under_way()
    world.port("hold_robot").put(robot="cyan1", held=False)
    world.iterate(20)
    assert sensor(world, "cyan1").kick_id == 1


def test_reset_drops_all_kicks() -> None:
    world = with_kick_under_way()
    world.port("reset").put()
    world.iterate(20)
    assert [sensor(world, robot).kick_id for robot in ("cyan1", "magenta1")] == [0, 0]


def test_reset_charges_all_kickers() -> None:
    world = with_kick_under_way()
    world.iterate(7)
    assert [sensor(world, robot).charged for robot in ("cyan1", "magenta1")] == [False, False]
    world.port("reset").put()
    world.iterate()
    for robot in ("cyan1", "magenta1"):
        assert (sensor(world, robot).charged, sensor(world, robot).charge) == (True, 1.0)
    kick(world, 2)
    world.iterate(7)
    assert sensor(world, "cyan1").kick_id == 2


def test_empty_battery_drops_the_kick_on_its_way() -> None:
    world = with_kick_under_way(physics={"battery": {"capacity_wh": 0.2 * 100.0 / 3600.0, "idle_w": 100.0}})
    world.iterate(20)
    assert world.port("battery_state", "cyan1").sent[-1].charge == 0.0
    assert sensor(world, "cyan1").kick_id == 0

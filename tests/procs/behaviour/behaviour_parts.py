"""Short descriptions of matches for tests of the behaviour."""

import math
from typing import Any

from fwk.testing import Bench
from lcmtypes.robot import motor_command_t
from procs.behaviour.roles import Job
from procs.behaviour.view import Agreement, Ball, Robot, View
from procs.model.field import Field, Point
from procs.model.robot import number_of

FIELD = Field()


def robot(name: str, x_m: float, y_m: float, heading_rad: float = 0.0, role: str = "") -> Robot:
    return Robot(name, Point(x_m, y_m), heading_rad, role=role, number=number_of(name))


def agreed(mate: Robot, passer: str = "cyan2") -> Robot:
    """Returns the mate as a robot that accepts the pass of another."""
    return mate._replace(agreement=Agreement(passer=passer))


def ball(x_m: float, y_m: float, vx_m_s: float = 0.0, vy_m_s: float = 0.0) -> Ball:
    return Ball(known=True, place=Point(x_m, y_m), velocity_m_s=Point(vx_m_s, vy_m_s))


def view(own: Robot, where: Ball, mates: tuple[Robot, ...] = (), opponents: tuple[Robot, ...] = ()) -> View:
    return View(localized=True, own=own, ball=where, mates=mates, opponents=opponents)


def job(role: str, x_m: float = 0.0, y_m: float = 0.0) -> Job:
    return Job(role, Point(x_m, y_m))


def newest(bench: Bench, port: str) -> Any:
    return bench.port(port).sent[-1]


def put(bench: Bench, port: str, **fields: Any) -> None:
    """Puts a message of this tick on the bench, which itself leaves the time at zero."""
    made: Any = bench.port(port).message_type()
    made.header.time_us = bench.time_us
    bench.port(port).put(made, **fields)


def moved(place: Point, heading_rad: float, command: motor_command_t) -> tuple[Point, float]:
    """Returns place and heading of a robot that has followed a command for a period of 0.05 s."""
    cos, sin = math.cos(heading_rad), math.sin(heading_rad)
    vx_m_s, vy_m_s = cos * command.vx_m_s - sin * command.vy_m_s, sin * command.vx_m_s + cos * command.vy_m_s
    return Point(place.x_m + 0.05 * vx_m_s, place.y_m + 0.05 * vy_m_s), heading_rad + 0.05 * command.omega_rad_s

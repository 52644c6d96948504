"""Touches of the ball and collisions of robots, in an order that does not depend on the physics engine."""

from typing import Any

import pymunk

from procs.model.events import Event, Kind
from procs.simulation.physics.arena import BALL, HULL, ROBOT
from procs.simulation.physics.robot_body import Robot


class Contacts:
    """Collects the contacts of the robots during one step of the physics engine."""

    def __init__(self, space: pymunk.Space, robots: list[Robot]) -> None:
        self._touching: set[str] = set()
        self._collisions: dict[tuple[str, str], Event] = {}
        self._robots = {shape: robot for robot in robots for shape in robot.body.shapes}
        space.on_collision(HULL, BALL, post_solve=self._touch)
        space.on_collision(ROBOT, ROBOT, begin=self._collide)

    def take_touches(self) -> set[str]:
        """Robots that touched the ball since the last call."""
        touching, self._touching = self._touching, set()
        return touching

    def take_collisions(self) -> list[Event]:
        """Returns the hardest collision of each pair of robots since the last call."""
        collisions = sorted(self._collisions.values())
        self._collisions.clear()
        return collisions

    def _touch(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        self._touching.add(self._robots[arbiter.shapes[0]].name)

    def _collide(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        one, two = sorted((self._robots[shape] for shape in arbiter.shapes), key=lambda robot: robot.name)
        towards = (two.body.position - one.body.position).normalized()
        one_m_s, two_m_s = one.body.velocity.dot(towards), -two.body.velocity.dot(towards)
        faster, slower = (one, two) if one_m_s >= two_m_s else (two, one)
        place = (one.body.position + two.body.position) / 2
        event = Event(Kind.COLLISION, faster.name, slower.name, place.x, place.y, one_m_s + two_m_s)
        known = self._collisions.get((one.name, two.name))
        if known is None or known.speed_m_s < event.speed_m_s:
            self._collisions[one.name, two.name] = event

"""Pushing: robots may touch each other, but not shove a rival away or run into it (2016, law 12)."""

import itertools
import math

from procs.model.events import Kind
from procs.model.field import Point
from procs.model.teams import team_number
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason

_REST = Point(0.0, 0.0)


def collisions(scene: Scene) -> list[Foul]:
    """Returns the fouls of robots that ran into rivals at speed."""
    return [
        Foul(event.robot, Reason.COLLISION, Point(event.x_m, event.y_m), direct=True)
        for event in scene.sight.events
        if event.kind is Kind.COLLISION
        and event.speed_m_s > scene.rules.collision_m_s
        and team_number(event.robot) is not team_number(event.other)
    ]


class Pushing:
    """Measures how far each robot has driven a rival before itself."""

    def __init__(self) -> None:
        self._pushed_m: dict[tuple[str, str], float] = {}

    def watch(self, scene: Scene) -> list[Foul]:
        """Returns the fouls of robots that pushed a rival too far, except of those that a rival drove there."""
        robots, rules, shoves = scene.sight.robots, scene.rules, {}
        for pusher, pushed in itertools.permutations(sorted(robots), 2):
            gap_m = math.dist(robots[pusher], robots[pushed]) - 2 * rules.robot.radius_m
            if team_number(pusher) is team_number(pushed) or gap_m > rules.apart_m:
                continue
            both_m_s = min(self._towards_m_s(scene, pusher, pushed, of) for of in (pusher, pushed))
            if both_m_s > rules.shove_m_s:
                way_m = both_m_s * scene.duration_s if gap_m <= rules.contact_m else 0.0
                shoves[pusher, pushed] = self._pushed_m.get((pusher, pushed), 0.0) + way_m
        driven = {pushed for _, pushed in shoves}
        self._pushed_m = {pair: way_m for pair, way_m in shoves.items() if pair[0] not in driven}
        guilty = [pusher for (pusher, _), way_m in self._pushed_m.items() if way_m > rules.pushing_m]
        if guilty:
            self._pushed_m = {}
        return [Foul(pusher, Reason.PUSHING, robots[pusher], direct=True) for pusher in guilty]

    @staticmethod
    def _towards_m_s(scene: Scene, pusher: str, pushed: str, of: str) -> float:
        """Returns the speed of a robot in the direction from the pusher to the pushed."""
        start, end = scene.sight.robots[pusher], scene.sight.robots[pushed]
        velocity, distance_m = scene.sight.velocities_m_s.get(of, _REST), math.dist(start, end) or 1.0
        return ((end.x_m - start.x_m) * velocity.x_m + (end.y_m - start.y_m) * velocity.y_m) / distance_m

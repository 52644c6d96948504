"""Skills without the ball: stop, goto, mark."""

import math

from procs.behaviour.skills.skill import Drive, Scene, Skill, Status, Step
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad

_NEAR_M = 0.1
_NEAR_RAD = 0.1
_MARK_M = 0.9


class Stop(Skill):
    """Stands still."""

    lasting = True

    def step(self, _scene: Scene) -> Step:
        return Step(status=Status.FINAL)


class Goto(Skill):
    """Drives to the place and heading, around the ball, and stays there."""

    lasting = True

    def step(self, scene: Scene) -> Step:
        return _stand(scene, scene.place, scene.heading_rad)


class Mark(Skill):
    """Stands between the opponent at the place and the own goal, facing the ball."""

    lasting = True

    def step(self, scene: Scene) -> Step:
        goal = scene.field.goal_centre(-1.0)
        place = ahead(scene.place, bearing_rad(scene.place, goal), min(_MARK_M, math.dist(scene.place, goal)))
        return _stand(scene, place, bearing_rad(place, scene.view.ball.place))


def _stand(scene: Scene, place: Point, heading_rad: float) -> Step:
    own = scene.view.own
    turned_rad = abs(wrap_rad(own.heading_rad - heading_rad))
    there = math.dist(own.place, place) < _NEAR_M and turned_rad < _NEAR_RAD
    drive = Drive(place, heading_rad, scene.speed_m_s, avoid_ball=True)
    return Step(drive, status=Status.FINAL if there else Status.RUNNING)

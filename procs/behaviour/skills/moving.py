"""Skills without the ball: stop, goto, mark."""

import math
from abc import abstractmethod

from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad

_NEAR_M = 0.1
_NEAR_RAD = 0.1
_MARK_M = 0.9


class Stop(StateMachine):
    """Stands still."""

    lasting = True

    def _stand(self, _scene: Scene) -> Step:
        return Step()

    STATES = (State("stand", _stand, status=Status.FINAL),)


class _Place(StateMachine):
    """Drives to a place and a heading, around the ball, and stays there."""

    lasting = True

    @abstractmethod
    def _target(self, scene: Scene) -> tuple[Point, float]:
        """Returns place and heading."""

    def _drive(self, scene: Scene) -> Step:
        return Step(Drive(*self._target(scene), scene.speed_m_s, avoid_ball=True))

    def _there(self, scene: Scene) -> bool:
        own, (place, heading_rad) = scene.view.own, self._target(scene)
        turned_rad = abs(wrap_rad(own.heading_rad - heading_rad))
        return math.dist(own.place, place) < _NEAR_M and turned_rad < _NEAR_RAD

    def _away(self, scene: Scene) -> bool:
        return not self._there(scene)

    STATES = (
        State("drive", _drive, (Exit(_there, "stay"),)),
        State("stay", _drive, (Exit(_away, "drive"),), status=Status.FINAL),
    )


class Goto(_Place):
    """Drives to the place and heading, around the ball, and stays there."""

    def _target(self, scene: Scene) -> tuple[Point, float]:
        return scene.place, scene.heading_rad


class Mark(_Place):
    """Stands between the opponent at the place and the own goal, facing the ball."""

    def _target(self, scene: Scene) -> tuple[Point, float]:
        goal = scene.field.goal_centre(-1.0)
        place = ahead(scene.place, bearing_rad(scene.place, goal), min(_MARK_M, math.dist(scene.place, goal)))
        return place, bearing_rad(place, scene.view.ball.place)

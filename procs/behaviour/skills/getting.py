"""Skills that win the ball: get_ball drives to it, intercept waits on its way."""

import math
from abc import abstractmethod

from procs.behaviour import ballistics
from procs.behaviour.skills.skill import Drive, Scene, Skill, Status, Step, failed
from procs.model.ball import BALL
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad
from procs.model.robot import ROBOT

_HANDLING_ON_M = 1.0
_PUSH_M = ROBOT.held_ball_m(BALL) - 0.06  # middles of robot and ball when the ball is pressed into the mouth
_STAGING_M = 0.75
_ALIGNED_RAD = 0.35
_ENTRY_M_S = 0.5
_HELD_M = 0.5  # an opponent this near to the ball has it
_SURE_S = 0.1  # the light barrier must see the ball so long


class _Capture(Skill):
    """Ends when the ball has been in the mouth for a moment."""

    def __init__(self) -> None:
        self._held_s = 0.0

    def step(self, scene: Scene) -> Step:
        self._held_s = self._held_s + scene.duration_s if scene.holds_ball else 0.0
        if self._held_s >= _SURE_S:
            return Step(dribble=True, status=Status.FINAL)
        if not scene.view.ball.known and not scene.holds_ball:
            return failed("the ball is unknown")
        return Step(self._approach(scene), dribble=self._near(scene))

    def _near(self, scene: Scene) -> bool:
        return scene.holds_ball or math.dist(scene.view.own.place, scene.view.ball.place) < _HANDLING_ON_M

    @abstractmethod
    def _approach(self, scene: Scene) -> Drive:
        """Returns the drive towards the ball."""


class GetBall(_Capture):
    """Drives to the ball, mouth first; if an opponent has the ball, from the side of the own goal.

    A set piece's ball it takes from behind, so that it can play at once.
    """

    def _approach(self, scene: Scene) -> Drive:
        own, ball = scene.view.own.place, scene.view.ball
        meeting = ballistics.meet(ball, own).place
        if not scene.holds_ball and any(math.dist(other.place, ball.place) < _HELD_M for other in scene.view.opponents):
            goal_rad = bearing_rad(meeting, scene.field.goal_centre(-1.0))
            return Drive(ahead(meeting, goal_rad, _PUSH_M), wrap_rad(goal_rad + math.pi), scene.speed_m_s, _ENTRY_M_S)
        way_rad = bearing_rad(own, meeting)
        off_rad = abs(wrap_rad(way_rad - scene.heading_rad))
        if scene.set_piece and off_rad > _ALIGNED_RAD:
            return Drive(ahead(meeting, scene.heading_rad, -_STAGING_M), scene.heading_rad, avoid_ball=True)
        facing_rad = bearing_rad(own, ball.place)  # a rolling ball comes from there, wherever it is met
        return Drive(ahead(meeting, facing_rad, -_PUSH_M), facing_rad, scene.speed_m_s, _ENTRY_M_S)


class Intercept(_Capture):
    """Stands in the way of a rolling ball, facing it."""

    def _approach(self, scene: Scene) -> Drive:
        own, ball = scene.view.own.place, scene.view.ball
        facing_rad = bearing_rad(own, ball.place)
        speed_m_s = ball.speed_m_s
        if speed_m_s < 0.3:
            return Drive(ahead(ball.place, facing_rad, -_PUSH_M), facing_rad, scene.speed_m_s, _ENTRY_M_S)
        along = Point(ball.velocity_m_s.x_m / speed_m_s, ball.velocity_m_s.y_m / speed_m_s)
        passed_m = (own.x_m - ball.place.x_m) * along.x_m + (own.y_m - ball.place.y_m) * along.y_m
        foot = Point(ball.place.x_m + passed_m * along.x_m, ball.place.y_m + passed_m * along.y_m)
        in_time = ballistics.reach_s(math.dist(own, foot)) < passed_m / speed_m_s
        target = foot if in_time else ballistics.meet(ball, own).place
        return Drive(target, facing_rad, scene.speed_m_s)

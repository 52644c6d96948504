"""Skills that win the ball: get_ball drives to it, intercept waits on its way."""

import math
from abc import abstractmethod

from procs.behaviour import ballistics
from procs.behaviour.interception import Interception
from procs.behaviour.skills.skill import Drive, Scene, Skill, Status, Step, failed
from procs.model.ball import BALL
from procs.model.geometry import ahead, bearing_rad, wrap_rad
from procs.model.robot import ROBOT

_HANDLING_ON_M = 1.0
_PUSH_M = ROBOT.held_ball_m(BALL) - 0.04  # middles of robot and ball when the ball is pressed into the mouth
_STAGING_M = 0.75
_ALIGNED_RAD = 0.9
_FACING_RAD = 0.25
_WAITING_M = 0.5  # from the ball of a set piece until the mouth faces it
_ENTRY_M_S = 0.25  # relative to the ball, which bounces off a faster mouth
_CONTACT_M = ROBOT.held_ball_m(BALL)
_NEAR_M = 1.0  # so near to the ball the robot gets slower ...
_SOFT_1_S = 2.0  # ... by this speed for each metre, because it follows its commands late
_GENTLE_1_S = 1.2  # the same at a set piece, which is not to be bumped away
_SLOW_M_S = 0.5  # a faster ball has to be caught first
_CONTEST_M = 1.2  # a rival so near to the ball leaves no time for that
_HELD_M = 0.5  # an opponent this near to the ball has it
_KEPT_M_S = 3.6  # a faster ball bounces off a standing mouth; the robot gives before it ...
_GIVING_S, _GIVING_M, _GIVING_M_S = 0.5, 0.4, 0.7  # ... from so long before its arrival, so far and so fast
_ON_LINE_M = 0.3
_SURE_S = 0.1  # the light barrier must see the ball so long


class _Capture(Skill):
    """Ends when the ball has been in the mouth for a moment."""

    def __init__(self) -> None:
        self._held_s = 0.0
        self._plan = Interception()

    def step(self, scene: Scene) -> Step:
        scene = scene._replace(view=scene.view._replace(ball=self._plan.smoothed(scene.view.ball, scene.duration_s)))
        self._held_s = self._held_s + scene.duration_s if scene.holds_ball else 0.0
        if self._held_s >= _SURE_S:
            return Step(dribble=True, status=Status.FINAL)
        if scene.holds_ball:  # the ball follows the robot, which stops before it has pulled the ball back
            return Step(Drive(scene.view.own.place, scene.view.own.heading_rad), dribble=True)
        if not scene.view.ball.known:
            return failed("the ball is unknown")
        return Step(self._approach(scene), dribble=self._near(scene))

    def _near(self, scene: Scene) -> bool:
        return math.dist(scene.view.own.place, scene.view.ball.place) < _HANDLING_ON_M

    def _wait(self, scene: Scene) -> Drive | None:
        """Returns the drive to the first place in the way of the ball; None if there is none in time."""
        own, ball = scene.view.own, scene.view.ball
        stand = self._plan.stand(ball, own, scene.duration_s)
        if stand is None:
            return None
        excess_m_s = ball.speed_m_s - _KEPT_M_S
        if excess_m_s > 0.0 and stand.time_s < _GIVING_S and math.dist(stand.place, own.place) < _ON_LINE_M:
            way_rad = wrap_rad(stand.heading_rad + math.pi)
            return Drive(ahead(stand.place, way_rad, _GIVING_M), stand.heading_rad, min(excess_m_s, _GIVING_M_S))
        return Drive(stand.place, stand.heading_rad, scene.speed_m_s)

    @abstractmethod
    def _approach(self, scene: Scene) -> Drive:
        """Returns the drive towards the ball."""


class GetBall(_Capture):
    """Drives to the ball, mouth first; if an opponent has the ball, from the side of the own goal.

    A set piece's ball it takes from behind, so that it can play at once.
    """

    def _approach(self, scene: Scene) -> Drive:
        own, ball = scene.view.own.place, scene.view.ball
        meeting = ballistics.meet(ball, own, scene.view.own.velocity_m_s).place
        if any(math.dist(other.place, ball.place) < _HELD_M for other in scene.view.opponents):
            goal_rad = bearing_rad(meeting, scene.field.goal_centre(-1.0))
            return Drive(ahead(meeting, goal_rad, _PUSH_M), wrap_rad(goal_rad + math.pi), scene.speed_m_s, _ENTRY_M_S)
        way_rad = bearing_rad(own, meeting)
        off_rad = abs(wrap_rad(way_rad - scene.heading_rad))
        if scene.set_piece and off_rad > _ALIGNED_RAD:
            return Drive(ahead(meeting, scene.heading_rad, -_STAGING_M), scene.heading_rad, avoid_ball=True)
        facing_rad = bearing_rad(own, ball.place)
        turned = abs(wrap_rad(facing_rad - scene.view.own.heading_rad)) < _FACING_RAD
        if scene.set_piece and not turned:
            return Drive(ahead(ball.place, facing_rad, -_WAITING_M), facing_rad)
        return self._wait(scene) or drive_to(scene)


class Intercept(_Capture):
    """Waits on the way of a rolling ball, facing it, and gives before a fast one; drives to a ball that outruns it."""

    def _approach(self, scene: Scene) -> Drive:
        return self._wait(scene) or drive_to(scene)


def drive_to(scene: Scene) -> Drive:
    """Returns the drive to where the robot meets the ball, as fast as the ball plus a little."""
    own, ball = scene.view.own, scene.view.ball
    meeting = ballistics.meet(ball, own.place, own.velocity_m_s).place
    facing_rad = bearing_rad(own.place, ball.place)  # a rolling ball comes from there, wherever it is met
    flees_m_s = ball.velocity_m_s.x_m * math.cos(facing_rad) + ball.velocity_m_s.y_m * math.sin(facing_rad)
    end_m_s = _ENTRY_M_S + max(0.0, flees_m_s)
    gap_m = max(0.0, math.dist(own.place, ball.place) - _CONTACT_M)
    limit_m_s = max(_ENTRY_M_S, _ENTRY_M_S + _SOFT_1_S * gap_m + flees_m_s)
    contested = any(math.dist(other.place, ball.place) < _CONTEST_M for other in scene.view.opponents)
    if scene.set_piece:
        limit_m_s = min(limit_m_s, _ENTRY_M_S + _GENTLE_1_S * gap_m)
    elif contested or gap_m > _NEAR_M or ball.speed_m_s > _SLOW_M_S:
        limit_m_s = scene.speed_m_s
    elif scene.speed_m_s:
        limit_m_s = min(limit_m_s, scene.speed_m_s)
    return Drive(ahead(meeting, facing_rad, -_PUSH_M), facing_rad, limit_m_s, end_m_s)

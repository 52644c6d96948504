"""Skills that win the ball: get_ball drives to it, intercept waits on its way, receive expects an announced pass."""

import math

from procs.behaviour import ballistics
from procs.behaviour.interception import Interception, Stand
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine, otherwise
from procs.behaviour.view import Ball, Robot
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad

_HANDLING_ON_M = 1.0  # from the ball the handling is on
_PRESSED_M = 0.04  # by which the robot aims too near to the ball, to press it into the mouth
_STAGING_M = 0.75  # behind the ball of a set piece, where the robot turns towards it
_ALIGNED_RAD = 0.9  # a robot whose way to that ball differs more from the kick's direction comes from beside
_FACING_RAD, _GOAL_FACING_RAD = 0.25, 0.45  # the mouth faces that ball, or one before the own goal, within this angle
_WAITING_M = 0.14  # from the body to the ball of a set piece until the mouth faces it ...
_GOAL_WAITING_M = 0.25  # ... or to the ball before the own goal
_OWN_GOAL_M, _BESIDE_GOAL_M = 0.8, 0.2  # a ball so near to the own goal, or so far beside it, may roll into it
_PUSHED_HOME_M = 2.0  # from so near a bumped ball rolls into the own goal
_ENTRY_M_S = 0.25  # relative to the ball, which bounces off a faster mouth
_NEAR_M = 1.0  # so near to the ball the robot gets slower ...
_SOFT_1_S = 2.0  # ... by this speed for each metre, because it follows its commands late
_GENTLE_1_S = 1.2  # the same at a set piece, and before the own goal: that ball is not to be bumped away
_SLOW_M_S = 0.5  # a faster ball has to be caught first
_CONTEST_M = 1.2  # a rival so near to the ball leaves no time for that
HELD_M = 0.14
"""A robot with the ball so near to its body has it."""
_KEPT_M_S = 3.6  # a faster ball bounces off a standing mouth; the robot gives before it ...
_GIVING_S, _GIVING_M, _GIVING_M_S = 0.5, 0.4, 0.7  # ... from so long before its arrival, so far and so fast
_ON_LINE_M = 0.3  # a robot this near to its place on the ball's way has got there
_PASSED_M_S = 1.2  # a pass is at least so fast ...
_TOWARDS = 0.7  # ... and comes towards the robot: cosine of the angle
_WITH_MATE_M = 0.06  # the passer has a ball so near to its body
_SURE_S = 0.1  # the light barrier must see the ball so long
_STANDS_M_S = 0.5  # a faster robot leaves the side of the ball where it is
_ROOM_M = 0.04  # between the robot at the ball and a standing one, without which it would touch it
_SIDES_RAD = (0.0, *(sign * 0.2 * step for step in range(1, 16) for sign in (1, -1)))


class _Capture(StateMachine):
    """Ends when the ball has been in the mouth for a moment."""

    def __init__(self) -> None:
        super().__init__()
        self._held_s = 0.0
        self._plan = Interception()
        self._stand: Stand | None = None

    def _watch(self, scene: Scene) -> Scene:
        self._held_s = self._held_s + scene.duration_s if scene.holds_ball else 0.0
        return scene._replace(view=scene.view._replace(ball=self._plan.smoothed(scene.view.ball, scene.duration_s)))

    def _in_mouth(self, scene: Scene) -> bool:
        return scene.holds_ball

    def _slipped(self, scene: Scene) -> bool:
        return not scene.holds_ball

    def _sure(self, _scene: Scene) -> bool:
        return self._held_s >= _SURE_S

    def _ball_unknown(self, scene: Scene) -> bool:
        return not scene.view.ball.known

    def _ball_comes(self, scene: Scene) -> bool:
        """Whether there is a place in the way of the ball in time; the robot waits at the first one."""
        self._stand = self._plan.stand(scene.view, scene.duration_s)
        return self._stand is not None

    def _fast_ball_arrives(self, scene: Scene) -> bool:
        assert self._stand
        near = math.dist(self._stand.place, scene.view.own.place) < _ON_LINE_M
        return scene.view.ball.speed_m_s > _KEPT_M_S and self._stand.time_s < _GIVING_S and near

    def _settle(self, scene: Scene) -> Step:
        """Stops the robot before it has pulled the ball back; the ball follows."""
        return Step(Drive(scene.view.own.place, scene.view.own.heading_rad), dribble=True)

    def _keep_ball(self, _scene: Scene) -> Step:
        return Step(dribble=True)

    def _wait(self, scene: Scene) -> Step:
        assert self._stand
        return _approach(scene, Drive(self._stand.place, self._stand.heading_rad, scene.speed_m_s))

    def _give(self, scene: Scene) -> Step:
        assert self._stand
        way_rad = wrap_rad(self._stand.heading_rad + math.pi)
        speed_m_s = min(scene.view.ball.speed_m_s - _KEPT_M_S, _GIVING_M_S)
        return _approach(scene, Drive(ahead(self._stand.place, way_rad, _GIVING_M), self._stand.heading_rad, speed_m_s))

    def _drive_to(self, scene: Scene) -> Step:
        return _approach(scene, drive_to(scene))

    _DRIVE = State("drive to it", _drive_to)
    _MEET = State(
        "meet it",
        inside=(State("wait", _wait), State("give", _give)),
        choice=(Exit(_fast_ball_arrives, "give"), Exit(otherwise, "wait")),
    )
    _EXITS = (Exit(_in_mouth, "settle"), Exit(_ball_unknown, "the ball is unknown"))
    _ENDS = (
        State("settle", _settle, (Exit(_sure, "caught"), Exit(_slipped, "approach"))),
        State("caught", _keep_ball, status=Status.FINAL),
        State("the ball is unknown", status=Status.FAILED),
    )
    _FOUND = (Exit(_ball_comes, "meet it"), Exit(otherwise, "drive to it"))


class GetBall(_Capture):
    """Drives to the ball, mouth first; if an opponent has the ball, from the side of the own goal.

    A set piece's ball it takes from behind, so that it can play at once. A ball between it and its own goal it touches
    with the mouth alone, as any other touch would push it in.
    """

    def _opponent_has_it(self, scene: Scene) -> bool:
        return scene.view.is_at_ball(scene.view.opponents, HELD_M) and not _would_push_it_home(scene)

    def _set_piece_from_beside(self, scene: Scene) -> bool:
        if not scene.set_piece:
            return False
        way_rad = bearing_rad(scene.view.own.place, _meeting(scene))
        return abs(wrap_rad(way_rad - scene.heading_rad)) > _ALIGNED_RAD

    def _set_piece_not_faced(self, scene: Scene) -> bool:
        return scene.set_piece and _off_mouth_rad(scene) >= _FACING_RAD

    def _before_own_goal_not_faced(self, scene: Scene) -> bool:
        return _is_before_own_goal(scene) and _off_mouth_rad(scene) >= _GOAL_FACING_RAD

    def _contest(self, scene: Scene) -> Step:
        meeting = _meeting(scene)
        facing_rad = _free_side_rad(scene, meeting, bearing_rad(scene.field.goal_centre(-1.0), meeting))
        place = ahead(meeting, facing_rad, -_pressed_m(scene))
        return _approach(scene, Drive(place, facing_rad, scene.speed_m_s, _ENTRY_M_S))

    def _go_behind(self, scene: Scene) -> Step:
        place = ahead(_meeting(scene), scene.heading_rad, -_STAGING_M)
        return _approach(scene, Drive(place, scene.heading_rad, avoid_ball=True))

    def _face(self, scene: Scene) -> Step:
        return _approach(scene, _waiting(scene, _WAITING_M))

    def _face_before_goal(self, scene: Scene) -> Step:
        drive = _waiting(scene, _GOAL_WAITING_M)
        limit_m_s = _ENTRY_M_S + _GENTLE_1_S * math.dist(scene.view.own.place, drive.place)
        return _approach(scene, drive._replace(speed_m_s=min(limit_m_s, scene.speed_m_s or math.inf)))

    STATES = (
        State(
            "approach",
            exits=_Capture._EXITS,
            inside=(
                _Capture._DRIVE,
                _Capture._MEET,
                State("contest", _contest),
                State("go behind it", _go_behind),
                State("face it", _face),
                State("turn before the own goal", _face_before_goal),
            ),
            choice=(
                Exit(_opponent_has_it, "contest"),
                Exit(_set_piece_from_beside, "go behind it"),
                Exit(_set_piece_not_faced, "face it"),
                Exit(_before_own_goal_not_faced, "turn before the own goal"),
                *_Capture._FOUND,
            ),
        ),
        *_Capture._ENDS,
    )


class Intercept(_Capture):
    """Waits on the way of a rolling ball, facing it, and gives before a fast one; drives to a ball that outruns it."""

    STATES = (
        State(
            "approach",
            exits=_Capture._EXITS,
            inside=(_Capture._DRIVE, _Capture._MEET),
            choice=_Capture._FOUND,
        ),
        *_Capture._ENDS,
    )


class Receive(_Capture):
    """Stands and looks at the passer until the announced pass comes; then takes the ball as intercept does."""

    def _pass_comes(self, scene: Scene) -> bool:
        view = scene.view
        return comes_fast(view.ball, view.own) and not view.is_at_ball(view.mates, _WITH_MATE_M)

    def _nothing_to_see(self, scene: Scene) -> bool:
        return not scene.view.ball.known and _passer(scene) is None

    def _await(self, scene: Scene) -> Step:
        own, passer = scene.view.own, _passer(scene)
        seen = passer.place if passer and not scene.view.ball.known else scene.view.ball.place
        return Step(Drive(own.place, bearing_rad(own.place, seen), scene.speed_m_s, avoid_ball=True))

    STATES = (
        State(
            "await",
            _await,
            (
                Exit(_Capture._in_mouth, "settle"),
                Exit(_pass_comes, "approach"),
                Exit(_nothing_to_see, "the ball is unknown"),
            ),
        ),
        *Intercept.STATES,
    )


def comes_fast(ball: Ball, robot: Robot, share: float = 1.0) -> bool:
    """Returns whether the ball rolls fast, and towards the robot; a smaller share of both will do if it is stated."""
    to_x_m, to_y_m = robot.place.x_m - ball.place.x_m, robot.place.y_m - ball.place.y_m
    towards = ball.velocity_m_s.x_m * to_x_m + ball.velocity_m_s.y_m * to_y_m
    straight = ball.speed_m_s * math.hypot(to_x_m, to_y_m)
    return ball.speed_m_s > share * _PASSED_M_S and towards > share * _TOWARDS * straight


def _passer(scene: Scene) -> Robot | None:
    """Returns the mate that announces a pass to the robot."""
    own = scene.view.own.name
    return next((mate for mate in scene.view.mates if mate.agreement.receiver == own), None)


def _off_mouth_rad(scene: Scene) -> float:
    """Returns the angle between the way to the ball and the robot's heading."""
    facing_rad = bearing_rad(scene.view.own.place, scene.view.ball.place)
    return abs(wrap_rad(facing_rad - scene.view.own.heading_rad))


def _is_before_own_goal(scene: Scene) -> bool:
    """Returns whether a slow ball lies between the robot and its own goal, so near that a touch may push it in."""
    ball, field = scene.view.ball, scene.field
    near = ball.place.x_m < _OWN_GOAL_M - field.half_length_m and ball.speed_m_s < _SLOW_M_S
    beside = abs(ball.place.y_m) > field.goal_width_m / 2 + _BESIDE_GOAL_M
    return near and not beside and scene.view.own.place.x_m > ball.place.x_m


def _would_push_it_home(scene: Scene) -> bool:
    """Returns whether the way to the other side of a ball near the own goal leads through the ball."""
    ball, goal = scene.view.ball, scene.field.goal_centre(-1.0)
    near = math.dist(goal, ball.place) < _PUSHED_HOME_M
    return near and ball.speed_m_s < _PASSED_M_S and scene.view.ball_is_nearer_to(goal)


def _waiting(scene: Scene, off_m: float) -> Drive:
    """Returns the drive to the nearest place whose distance from the body to the ball is `off_m`, mouth to the ball."""
    own, ball, bodies = scene.view.own.place, scene.view.ball.place, scene.view.bodies
    facing_rad = bearing_rad(own, ball)
    return Drive(ahead(ball, facing_rad, -(bodies.beside_m + off_m)), facing_rad)


def _meeting(scene: Scene) -> Point:
    return ballistics.meet(scene.view).place


def _pressed_m(scene: Scene) -> float:
    """Returns the distance of the middles of robot and ball when the ball is pressed into the mouth."""
    return scene.view.bodies.held_ball_m - _PRESSED_M


def _free_side_rad(scene: Scene, ball: Point, facing_rad: float) -> float:
    """Returns the heading nearest to `facing_rad` with which the robot at the ball touches no standing stranger."""
    view, reach_m = scene.view, _pressed_m(scene)
    width_m, strangers = 2 * view.bodies.robot_radius_m, (*view.opponents, *view.silent_mates)
    standing = [each.place for each in strangers if math.hypot(*each.velocity_m_s) < _STANDS_M_S]

    def room_m(side_rad: float) -> float:
        place = ahead(ball, side_rad, -reach_m)
        return min((math.dist(place, other) for other in standing), default=math.inf) - width_m

    if room_m(facing_rad) > 0.0:
        return facing_rad
    sides_rad = (wrap_rad(facing_rad + turn_rad) for turn_rad in _SIDES_RAD)
    return next((side_rad for side_rad in sides_rad if room_m(side_rad) > _ROOM_M), facing_rad)


def _approach(scene: Scene, drive: Drive) -> Step:
    """Returns the step of a drive towards the ball; near it the handling is on."""
    return Step(drive, dribble=math.dist(scene.view.own.place, scene.view.ball.place) < _HANDLING_ON_M)


def drive_to(scene: Scene) -> Drive:
    """Returns the drive to where the robot meets the ball, as fast as the ball plus a little."""
    own, ball = scene.view.own, scene.view.ball
    meeting = ballistics.meet(scene.view).place
    facing_rad = bearing_rad(own.place, ball.place)  # a rolling ball comes from there, wherever it is met
    if ball.speed_m_s < _SLOW_M_S:
        facing_rad = _free_side_rad(scene, meeting, facing_rad)
    flees_m_s = ball.velocity_m_s.x_m * math.cos(facing_rad) + ball.velocity_m_s.y_m * math.sin(facing_rad)
    end_m_s = _ENTRY_M_S + max(0.0, flees_m_s)
    gap_m = max(0.0, math.dist(own.place, ball.place) - scene.view.bodies.held_ball_m)
    limit_m_s = max(_ENTRY_M_S, _ENTRY_M_S + _SOFT_1_S * gap_m + flees_m_s)
    contested = ball.is_near(scene.view.opponents, _CONTEST_M)
    if scene.set_piece or (_is_before_own_goal(scene) and not contested):
        limit_m_s = min(limit_m_s, _ENTRY_M_S + _GENTLE_1_S * gap_m, scene.speed_m_s or math.inf)
    elif contested or gap_m > _NEAR_M or ball.speed_m_s > _SLOW_M_S:
        limit_m_s = scene.speed_m_s
    elif scene.speed_m_s:
        limit_m_s = min(limit_m_s, scene.speed_m_s)
    return Drive(ahead(meeting, facing_rad, -_pressed_m(scene)), facing_rad, limit_m_s, end_m_s)

"""Decision of a robot: from its view of the match, the referee's state and its job to an order for a skill."""

import math
from typing import NamedTuple

from procs.behaviour import aim, ballistics, formation
from procs.behaviour.game import Game, Whose
from procs.behaviour.roles import ABSENT, ATTACKER, DEFENDER, GOALKEEPER, Job
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point
from procs.model.geometry import ahead, bearing_rad, clamp
from procs.referee.restarts import State

_SHOT_RANGE_M = 9.0  # less than half the field: a goal from the own half would not count
_ROOM_M = 0.15  # beside a shot's way at the goal ...
_ROOM_PRESSED_M = 0.05  # ... or less before the ball is lost
_BACK_M = 1.0  # a pass may lose so much ground
_PRESSED_M = 1.3
_DANGER_M = -4.0  # so near to the own goal a pressed robot rather clears the ball
_PATIENCE_S = 2.5  # with the ball, then a poorer shot or a pass will do
_MARK_M = 3.0  # a defender leaves its place for an opponent this near
_HELD_M = 0.5  # an opponent this near to the ball has it
_FAST_BALL_M_S = 1.2
_KICK_OFF_RAD = 0.8
_BARRED_S = 4.0  # by then another robot has touched the ball of a set piece, or the game was interrupted
_TOUCHED_M = 0.4
_BENCH_M = 8.0  # from the halfway line
_FREE_S = 0.3  # a ball that is lost for longer is set free
_DRIBBLE_M = 1.0  # then a poorer shot or a pass will do ...
_RELEASE_M = 1.5  # ... and then the ball must go; the rules allow 3 m, and braking takes its way
_LONGEST_M = 2.3
_PUSH_M = 3.0
_PUSH_M_S = 1.2
_SLOW_BALL_M_S = 2.5


class Order(NamedTuple):
    """A skill and its target in the attack frame."""

    skill: str
    place: Point = Point(0.0, 0.0)
    heading_rad: float = 0.0
    intention: str = ""
    speed_m_s: float = 0.0
    """Of a pass: speed of the ball at its target; 0: the skill's own."""


class Tactics:
    """Decides for one robot, once a tick; keeps the last order."""

    def __init__(self, field: Field) -> None:
        self.field = field
        self._last = Order("stop")
        self._held_s = 0.0
        self._held_from: Point | None = None
        self._free_s = 0.0
        self._taking = False  # the ball in the mouth is that of the own set piece
        self._penalty = False  # that set piece is a penalty
        self._barred_s = 0.0

    @property
    def barred(self) -> bool:
        """Whether the robot has taken a set piece, and no other robot has touched the ball since."""
        return self._barred_s > 0.0

    def decide(self, view: View, game: Game, job: Job, holds_ball: bool, duration_s: float) -> Order:
        """Returns the order for this tick, `duration_s` after the last."""
        self._held_s = self._held_s + duration_s if holds_ball else 0.0
        self._free_s = 0.0 if holds_ball else self._free_s + duration_s
        if self._free_s > _FREE_S:
            self._held_from = None
        elif holds_ball:
            self._held_from = self._held_from or view.ball.place
        self._barred_s = self._still_barred_s(view, game, holds_ball) - duration_s
        if not game.free_play:
            self._taking = game.whose is Whose.OURS and job.role == ATTACKER
            self._penalty = game.state is State.PENALTY
        elif not holds_ball:
            self._taking = False
        self._last = self._order(view, game, job, holds_ball)
        return self._last

    def _still_barred_s(self, view: View, game: Game, holds_ball: bool) -> float:
        """Returns for how long the robot leaves the ball alone after a set piece that it has taken."""
        others = (*view.mates, *view.opponents)
        if game.stopped or not view.mates or holds_ball:
            return 0.0
        if self._taking and self._last.skill in ("pass", "shoot"):
            return _BARRED_S  # it held the ball in the last tick and does not any more
        touched = any(math.dist(other.place, view.ball.place) < _TOUCHED_M for other in others)
        return 0.0 if touched else self._barred_s

    def _order(self, view: View, game: Game, job: Job, holds_ball: bool) -> Order:
        if game.paused or not view.localized:
            return Order("stop", intention="pause" if game.paused else "lost")
        if job.role == GOALKEEPER:
            return self._keep(view, game, holds_ball)
        if not game.free_play:
            return self._set_piece(view, game, job, holds_ball)
        if not view.ball.known:
            return self._stand(view, job.place, "search")
        if holds_ball:
            return self._play_ball(view)
        if job.role == ATTACKER and not keeper_takes(view, self.field):
            return self._go_for_ball(view)
        return self._help(view, game, job)

    def _keep(self, view: View, game: Game, holds_ball: bool) -> Order:
        if game.free_play and holds_ball:
            return self._pass_on(view, back_m=0.0) or self._clear(view)
        if game.free_play and view.ball.known and keeper_takes(view, self.field):
            return self._go_for_ball(view)
        return Order("keep_goal", intention="keep goal")

    def _set_piece(self, view: View, game: Game, job: Job, holds_ball: bool) -> Order:
        if job.role != ATTACKER:
            place = formation.helper_place(job.place, game, self.field)
            return self._stand(view, formation.next_step(view.own.place, place, game), "take position")
        if game.whose is not Whose.OURS:
            place = formation.first_opponent_place(game, self.field)
            return self._stand(view, formation.next_step(view.own.place, place, game), "keep distance")
        taker = Robot(view.own.name, game.spot, view.own.heading_rad)
        receiver = aim.best_pass(taker, _field_players(view), view.opponents, back_m=math.inf)
        target = receiver.place if receiver else self.field.goal_centre(1.0)
        way_rad = bearing_rad(game.spot, target)
        if game.state is State.KICK_OFF:  # from the own half
            way_rad = clamp(way_rad, -_KICK_OFF_RAD, _KICK_OFF_RAD)
        if game.stopped:
            return Order("goto", formation.taker_place(game.spot, way_rad), way_rad, "take set piece")
        if holds_ball:
            return self._play_ball(view)
        return Order("get_ball", game.spot, way_rad, "take set piece")

    def _play_ball(self, view: View) -> Order:
        pressed = any(math.dist(other.place, view.own.place) < _PRESSED_M for other in view.opponents)
        carried_m = math.dist(self._held_from, view.ball.place) if self._held_from else 0.0
        impatient = self._held_s > _PATIENCE_S or carried_m > _DRIBBLE_M
        if self._taking and self._penalty:
            return self._shot(view, room_m=0.0) or self._clear(view)
        if self._taking and view.mates:
            return self._pass_on(view, back_m=math.inf) or self._clear(view)
        if self._taking:
            order = self._shot(view, _ROOM_M)
        elif pressed or impatient:
            order = self._shot(view, _ROOM_PRESSED_M) or self._pass_on(view, back_m=_BACK_M)
        else:
            order = self._shot(view, _ROOM_M)
        in_danger = pressed and view.own.place.x_m < _DANGER_M
        if order is None and (in_danger or self._held_s > 2 * _PATIENCE_S):
            order = self._clear(view)
        if order is None and carried_m > _RELEASE_M:
            order = self._push(view)
        return order or self._dribble(view)

    def _dribble(self, view: View) -> Order:
        ball, goal = view.ball.place, self.field.goal_centre(1.0)
        target = Point(min(ball.x_m + 3.0, self.field.half_length_m - 2.5), clamp(0.6 * ball.y_m, -3.0, 3.0))
        start = self._held_from or ball
        if math.dist(start, target) > _LONGEST_M:
            target = ahead(start, bearing_rad(start, target), _LONGEST_M)
        return Order("dribble", target, bearing_rad(target, goal), "dribble")

    def _shot(self, view: View, room_m: float) -> Order | None:
        start = view.ball.place
        if math.dist(start, self.field.goal_centre(1.0)) > _SHOT_RANGE_M:
            return None
        best = aim.best_shot(start, _others(view), self.field)
        if self._last.skill == "shoot":
            kept_rad = aim.lane_rad(start, self._last.place, _others(view))
            if kept_rad > max(0.0, best.free_rad - 0.1):
                return self._last
        if best.free_rad * math.dist(start, best.place) < room_m:
            return None
        return Order("shoot", best.place, bearing_rad(start, best.place), "shoot")

    def _clear(self, view: View) -> Order:
        return Order("shoot", aim.best_shot(view.ball.place, _others(view), self.field).place, intention="clear")

    def _push(self, view: View) -> Order:
        """Sets the ball free, so that the robot can take it again: a slow pass ahead, where the way is free."""
        start = view.ball.place
        goal_rad = bearing_rad(start, self.field.goal_centre(1.0))
        places = [ahead(start, goal_rad + turn_rad, _PUSH_M) for turn_rad in (0.0, 0.5, -0.5, 1.0, -1.0)]
        inside = [place for place in places if self.field.in_field(*place, -0.5)] or places[:1]
        best = max(inside, key=lambda place: min(0.6, aim.lane_rad(start, place, _others(view), _SLOW_BALL_M_S)))
        return Order("pass", best, bearing_rad(start, best), "push", _PUSH_M_S)

    def _pass_on(self, view: View, back_m: float) -> Order | None:
        best = aim.best_pass(view.own, _field_players(view), view.opponents, back_m)
        if best is None or best.free_rad < aim.LANE_RAD:
            return None
        return Order("pass", best.place, bearing_rad(view.own.place, best.place), "pass")

    def _go_for_ball(self, view: View) -> Order:
        ball = view.ball
        goal_rad = bearing_rad(ball.place, self.field.goal_centre(1.0))
        towards = ball.velocity_m_s.x_m * (view.own.place.x_m - ball.place.x_m) + ball.velocity_m_s.y_m * (
            view.own.place.y_m - ball.place.y_m
        )
        distance_m = math.dist(view.own.place, ball.place)
        rolls_free = all(math.dist(other.place, ball.place) > _HELD_M for other in view.opponents)
        if rolls_free and ball.speed_m_s > _FAST_BALL_M_S and towards > 0.7 * ball.speed_m_s * distance_m:
            return Order("intercept", ball.place, goal_rad, "intercept")
        return Order("get_ball", ball.place, goal_rad, "get ball")

    def _help(self, view: View, game: Game, job: Job) -> Order:
        if job.role == DEFENDER:
            runner = _free_opponent(view)
            if runner and _nearest_defender(view, runner, _MARK_M):
                return Order("mark", runner.place, bearing_rad(runner.place, view.ball.place), "mark")
        return self._stand(view, formation.allowed(job.place, game, self.field), job.role)

    def _stand(self, view: View, place: Point, intention: str) -> Order:
        return Order("goto", place, bearing_rad(place, view.ball.place), intention)


def keeper_takes(view: View, field: Field) -> bool:
    """Returns whether the goalkeeper leaves its line: for a slow ball before its goal that it reaches first."""
    ball = view.ball
    if ball.speed_m_s > _FAST_BALL_M_S or not field.in_penalty_area(*ball.place, -1.0, 0.3):
        return False
    keepers = [robot for robot in (view.own, *view.mates) if robot.role == GOALKEEPER]
    if not keepers:
        return False
    others = [*view.opponents, *(robot for robot in (view.own, *view.mates) if robot.role != GOALKEEPER)]
    course = ballistics.Course(ball)
    keeper_s = course.meet(keepers[0].place).time_s
    return all(keeper_s < course.meet(other.place).time_s + 0.3 for other in others)


def leave_field(view: View, field: Field) -> Order:
    """Returns the order of a robot that was sent off: over the nearer touch line, and to wait there."""
    own = view.own.place
    place = Point(clamp(own.x_m, -_BENCH_M, _BENCH_M), math.copysign(field.half_width_m + field.border_m / 2, own.y_m))
    return Order("goto", place, view.own.heading_rad, "leave the field")


def _others(view: View) -> tuple[Robot, ...]:
    return (*view.opponents, *view.mates)


def _field_players(view: View) -> list[Robot]:
    return [mate for mate in view.mates if mate.role not in (GOALKEEPER, ABSENT)]


def _nearest_defender(view: View, runner: Robot, limit_m: float) -> bool:
    """Returns True if the own robot shall mark an opponent: within the limit, without a nearer defender."""
    own_m = math.dist(view.own.place, runner.place)
    defenders = [mate for mate in view.mates if mate.role == DEFENDER]
    return own_m < limit_m and all(own_m <= math.dist(mate.place, runner.place) for mate in defenders)


def _free_opponent(view: View) -> Robot | None:
    """Returns the opponent deepest in the own half, other than the one at the ball."""
    if len(view.opponents) < 2:
        return None
    at_ball = min(view.opponents, key=lambda other: (math.dist(other.place, view.ball.place), other.place))
    runners = [other for other in view.opponents if other is not at_ball and other.place.x_m < 0.0]
    return min(runners, key=lambda other: other.place, default=None)

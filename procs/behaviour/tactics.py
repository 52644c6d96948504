"""Decision of a robot: from its view of the match, the referee's state and its job to an order for a skill."""

import math

from procs.behaviour import aim, ballistics, formation
from procs.behaviour.ball_play import BallPlay, field_players
from procs.behaviour.game import Game, Whose
from procs.behaviour.order import Order
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, SUPPORTER, Job
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point
from procs.model.geometry import bearing_rad, clamp, wrap_rad
from procs.referee.restarts import State

_AREA_M = 1.2  # a marking robot would stand in the penalty area with an opponent so near to it
_MARK_M = 3.0  # a defender leaves its place for an opponent this near
_HELD_M = 0.5  # an opponent this near to the ball has it
_PASS_M = (1.5, 9.0)  # distances of a pass
_TURNED_RAD = 0.35
_FAST_BALL_M_S = 1.2
_KICK_OFF_RAD = 1.2  # nearly sideways: all mates are in the own half
_LAID_OFF = (State.FREE_KICK, State.THROW_IN, State.GOAL_KICK)
_BARRED_S = 4.0  # by then another robot has touched the ball of a set piece, or the game was interrupted
_TOUCHED_M = 0.4
_BENCH_M = 8.0  # from the halfway line
_PASSED_S = 1.0  # after a pass the passer leaves the ball to the receiver
_PASSED_M_S = 1.5
_SETTLED_S = 0.14  # a ball that was caught so long ago does not bounce off when the robot turns
_FUMBLED_M = 0.4  # the ball of a set piece that is so far from its spot has been taken
_NEAR_M = 1.0


class Tactics:
    """Decides for one robot, once a tick; keeps the last order."""

    def __init__(self, field: Field) -> None:
        self.field = field
        self._last = Order("stop")
        self._play = BallPlay(field)
        self._laid: Point | None = None  # place of the ball of the set piece at hand
        self._taking = False  # the ball in the mouth is that of the own set piece
        self._penalty = False  # that set piece is a penalty
        self._receiver = ""  # of the own set piece
        self._barred_s = 0.0
        self._passed_s = 0.0
        self._held_s = math.inf  # since the ball was caught

    @property
    def barred(self) -> bool:
        """Whether the robot leaves the ball to the others: it has taken a set piece, or has just passed."""
        return self._barred_s > 0.0 or self._passed_s > 0.0

    def decide(self, view: View, game: Game, job: Job, holds_ball: bool, duration_s: float) -> Order:
        """Returns the order for this tick, `duration_s` after the last."""
        self._held_s = self._held_s + duration_s if holds_ball else 0.0
        holds_ball = self._held_s >= _SETTLED_S
        self._play.watch(view, holds_ball, duration_s)
        if game.stopped:
            self._laid = view.ball.place
        self._barred_s = self._still_barred_s(view, game, holds_ball) - duration_s
        passed = self._last.intention == "pass" and not holds_ball and view.ball.speed_m_s > _PASSED_M_S
        self._passed_s = _PASSED_S if passed else max(0.0, self._passed_s - duration_s)
        if not game.free_play:
            self._taking = game.whose is Whose.OURS and job.role == ATTACKER
            self._penalty = game.state is State.PENALTY
        elif not holds_ball:
            self._taking, self._receiver = False, ""
        self._last = self._order(view, game, job, holds_ball)
        return self._last

    def _still_barred_s(self, view: View, game: Game, holds_ball: bool) -> float:
        """Returns for how long the robot leaves the ball alone after a set piece that it has taken."""
        others = (*view.mates, *view.opponents)
        if game.stopped or not view.mates or holds_ball:
            return 0.0
        if self._taking and self._last.skill in ("pass", "shoot"):
            return _BARRED_S  # it held the ball in the last tick and does not any more
        if self._taking and not game.free_play and self._fumbled(view):
            return _BARRED_S
        touched = any(math.dist(other.place, view.ball.place) < _TOUCHED_M for other in others)
        return 0.0 if touched else self._barred_s

    def _fumbled(self, view: View) -> bool:
        """Returns whether the robot has bumped the ball of the set piece away."""
        laid, ball = self._laid, view.ball.place
        return laid is not None and math.dist(ball, laid) > _FUMBLED_M and math.dist(view.own.place, ball) < _NEAR_M

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
            return self._play.relieve(view)
        if game.free_play and view.ball.known and keeper_takes(view, self.field):
            return self._go_for_ball(view)
        return Order("keep_goal", intention="keep goal")

    def _set_piece(self, view: View, game: Game, job: Job, holds_ball: bool) -> Order:
        lays_off = game.whose is Whose.OURS and game.state in _LAID_OFF
        if job.role != ATTACKER:
            receives = lays_off and job.role == SUPPORTER
            wanted = formation.layoff_place(game, self.field) if receives else job.place
            place = formation.helper_place(wanted, game, self.field)
            return self._stand(view, formation.next_step(view.own.place, place, game), "take position")
        if game.whose is not Whose.OURS:
            place = formation.first_opponent_place(game, self.field)
            return self._stand(view, formation.next_step(view.own.place, place, game), "keep distance")
        taker = Robot(view.own.name, game.spot, view.own.heading_rad)
        mates = field_players(view)
        if not game.stopped:  # the taker has turned to its receiver
            mates = [mate for mate in mates if mate.name == self._receiver] or mates
        near = [mate for mate in mates if mate.role == SUPPORTER] if lays_off else []
        best = aim.best_pass(taker, near or mates, view.opponents, math.inf, self._receiver)
        target = best.place if best else self.field.goal_centre(1.0)
        self._receiver = best.receiver if best else ""
        way_rad = bearing_rad(game.spot, target)
        if game.state is State.KICK_OFF:  # from the own half
            way_rad = clamp(way_rad, -_KICK_OFF_RAD, _KICK_OFF_RAD)
        if game.stopped:
            return Order("goto", formation.taker_place(game.spot, way_rad), way_rad, "take set piece")
        if holds_ball:
            return self._play_ball(view)
        return Order("get_ball", game.spot, way_rad, "take set piece")

    def _play_ball(self, view: View) -> Order:
        if self._taking and self._penalty:
            return self._play.take_penalty(view)
        if self._taking and view.mates:
            return self._play.take_set_piece(view, self._receiver)
        return self._play.decide(view)

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
        if _gets_pass(view):
            return self._stand(view, view.own.place, "await pass")
        if job.role == DEFENDER:
            runner = _free_opponent(view, self.field)
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
    keeper_s = course.meet(keepers[0].place, keepers[0].velocity_m_s).time_s
    return all(keeper_s < course.meet(other.place, other.velocity_m_s).time_s + 0.3 for other in others)


def leave_field(view: View, field: Field) -> Order:
    """Returns the order of a robot that was sent off: over the nearer touch line, and to wait there."""
    own = view.own.place
    place = Point(clamp(own.x_m, -_BENCH_M, _BENCH_M), math.copysign(field.half_width_m + field.border_m / 2, own.y_m))
    return Order("goto", place, view.own.heading_rad, "leave the field")


def _gets_pass(view: View) -> bool:
    """Returns whether the own robot waits for a pass: the mate with the ball turns to it, or would best pass to it."""
    own, ball = view.own.place, view.ball.place
    mates = field_players(view)
    for carrier in mates:
        if math.dist(carrier.place, ball) < _HELD_M and _PASS_M[0] < math.dist(own, ball) < _PASS_M[1]:
            if abs(wrap_rad(bearing_rad(carrier.place, own) - carrier.heading_rad)) < _TURNED_RAD:
                return True
            others = [view.own, *(mate for mate in mates if mate is not carrier)]
            best = aim.best_pass(carrier, others, view.opponents)
            return best is not None and best.receiver == view.own.name and best.free_rad >= aim.LANE_RAD
    return False


def _nearest_defender(view: View, runner: Robot, limit_m: float) -> bool:
    """Returns True if the own robot shall mark an opponent: within the limit, without a nearer defender."""
    own_m = math.dist(view.own.place, runner.place)
    defenders = [mate for mate in view.mates if mate.role == DEFENDER]
    return own_m < limit_m and all(own_m <= math.dist(mate.place, runner.place) for mate in defenders)


def _free_opponent(view: View, field: Field) -> Robot | None:
    """Returns the opponent deepest in the own half, other than the one at the ball.

    Opponents at the own penalty area are left to the goalkeeper: few other robots may be there.
    """
    if len(view.opponents) < 2:
        return None
    at_ball = min(view.opponents, key=lambda other: (math.dist(other.place, view.ball.place), other.place))
    runners = [
        other
        for other in view.opponents
        if other is not at_ball and other.place.x_m < 0.0 and not field.in_penalty_area(*other.place, -1.0, _AREA_M)
    ]
    return min(runners, key=lambda other: other.place, default=None)

"""Decision of a robot: from its view of the match, the referee's state and its job to an order for a skill."""

import math

import numpy as np

from procs.behaviour import aim, ballistics, formation, set_pieces
from procs.behaviour.ball_play import BallPlay, field_players
from procs.behaviour.game import Game, Whose
from procs.behaviour.order import Order
from procs.behaviour.passing import Passing
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, SUPPORTER, Job
from procs.behaviour.skills.getting import HELD_M, comes_fast
from procs.behaviour.skills.keeping import BEFORE_LINE_M
from procs.behaviour.view import Ball, Robot, View
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.geometry import ahead, bearing_rad, clamp

_AREA_M = 1.2  # a marking robot would stand in the penalty area with an opponent so near to it
_MARK_M = 3.0  # a defender leaves its place for an opponent this near
_FAST_BALL_M_S, _FETCHED_M, _SOONER_S = 1.2, 0.3, 0.3
"""The goalkeeper leaves its line for a slower ball, at most so far outside the penalty area, if no other robot reaches
it so much sooner."""
_GOES_ON_M_S, _GOES_ON_M, _GOES_ON_S = 0.5, 0.3, 0.4  # one on its way goes on while these hold with so much more
_MEETS_ON = 0.7  # a robot that meets a fast ball goes on while it is still so fast, and comes so straight
_KICK_OFF_RAD = 1.2  # nearly sideways: all mates are in the own half
_BARRED_S = 4.0  # by then another robot has touched the ball of a set piece, or the game was interrupted
_TOUCHED_M = 0.04  # a robot with the ball so near to its body has touched it
_OFFERS_M = (1.5, 2.5)  # before the penalty area, and aside of the ball that the goalkeeper takes, a mate awaits a pass
_GUARD_M = 1.2  # from the ball that it may not touch, a robot stands before the own goal
_BENCH_M = 3.0  # from the goal lines
_PASSED_S = 1.0  # after a pass the passer leaves the ball to the receiver
_PASSED_M_S = 1.5  # a ball that has left the robot faster has been passed
_SETTLED_S = 0.14  # a ball that was caught so long ago does not bounce off when the robot turns
_FUMBLED_M = 0.4  # the ball of a set piece that is so far from its spot has been taken
_NEAR_M = 1.0  # the taker this near to such a ball has taken it itself
_LEAVING_M, _GENTLE_M_S = 1.5, 1.0  # while a rival is so near to the ball, the taker comes so slowly
_BLOCKED_S = 0.4  # a rival that drives past does not change the plan of a set piece
_RESTS_M_S = 0.3  # a faster ball has been pushed off its spot
_BESIDE_M = (0.2, 0.8)  # a ball laid less far from the spot lies on it; one further away is put back
_STOPS_M_S2 = 2.8  # deceleration of a goalkeeper that drives home
_HOME_M = 1.0  # a goalkeeper this near to its penalty area goes straight home, even at a set piece
KEEPER_OUT_M = 2.3
"""The goalkeeper comes so far before its line."""
_WITH_BALL = ("dribble", "aim")
_TURNS = 12  # a multiple of the number of variants of each set piece


class Tactics:
    """Decides for one robot, once a tick; keeps the last order."""

    def __init__(self, field: Field, rng: np.random.Generator | None = None) -> None:
        """Draws the variants of set pieces; without a generator they take turns."""
        self.field = field
        self._rng = rng
        self._turn: int | None = None
        self._last = Order("stop")
        self.passing = Passing()
        """Agreement on a pass, for the messages to the team."""
        self._play = BallPlay(field, self.passing)
        self._laid: Point | None = None  # place of the ball of the set piece at hand
        self._laid_for = -1  # number of that set piece
        self._taking = False  # the ball in the mouth is that of the own set piece
        self._penalty = False  # that set piece is a penalty
        self._moved = False  # another robot has moved the ball of the set piece at hand
        self._receiver = ""  # of the own set piece
        self._planned: tuple[str, Point] | None = None
        self._planned_for = -1
        self._blocked_s = 0.0  # the way of the planned pass
        self._barred_s = 0.0
        self._passed_s = 0.0
        self._held_s = math.inf  # since the ball was caught
        self._fetches = False  # the goalkeeper has left its line for the ball

    @property
    def barred(self) -> bool:
        """Whether the robot leaves the ball to the others: it has taken a set piece, or has just passed."""
        return self._barred_s > 0.0 or self._passed_s > 0.0

    def decide(self, view: View, game: Game, job: Job, holds_ball: bool, duration_s: float) -> Order:
        """Returns the order for this tick, `duration_s` after the last."""
        self.passing.watch(view, holds_ball, duration_s)
        if holds_ball and not self._held_s and game.free_play:
            self._ask_early(view)
        self._held_s = self._held_s + duration_s if holds_ball else 0.0
        holds_ball = self._held_s >= _SETTLED_S
        self._play.watch(view, holds_ball, duration_s)
        self._note_laid(view.ball, game)
        game = self._as_laid(game)
        self._barred_s = self._still_barred_s(view, game, holds_ball) - duration_s
        passed = self._last.intention == "pass" and not holds_ball and view.ball.speed_m_s > _PASSED_M_S
        self._passed_s = _PASSED_S if passed else max(0.0, self._passed_s - duration_s)
        if not game.free_play:
            self._taking = game.whose is Whose.OURS and job.role == ATTACKER and not self.passing.said.passer
            self._penalty = game.state is State.PENALTY
            self._blocked_s = self._blocked_s + duration_s if self._blocked(view, game) else 0.0
        elif not holds_ball:
            self._taking, self._receiver = False, ""
        before, self._last = self._last, self._order(view, game, job, holds_ball)
        stops = game.stopped and not self._taking
        lost = not holds_ball and before.skill in _WITH_BALL
        if stops or lost or self._last.skill in ("shoot", "lob", "push", "clear"):
            self.passing.announce("")
        return self._last

    def _note_laid(self, ball: Ball, game: Game) -> None:
        """Notes where the ball of the set piece at hand lies; a robot may push it, and the crew puts it back."""
        if game.stopped:
            self._moved = False
        rests, laid = ball.known and ball.speed_m_s < _RESTS_M_S, self._laid
        if game.stopped and (not ball.known or laid is None or game.number != self._laid_for):
            self._laid = ball.place if ball.known else None
        elif rests and (game.stopped or (laid and math.dist(ball.place, game.spot) < math.dist(laid, game.spot))):
            self._laid = ball.place
        self._laid_for = game.number

    def _as_laid(self, game: Game) -> Game:
        """Returns the game with the set piece where its ball lies: a robot may have stood on the spot."""
        laid = self._laid
        if game.free_play or laid is None or not _BESIDE_M[0] < math.dist(laid, game.spot) < _BESIDE_M[1]:
            return game
        return game._replace(spot=laid)

    def _still_barred_s(self, view: View, game: Game, holds_ball: bool) -> float:
        """Returns for how long the robot leaves the ball alone after a set piece that it has taken."""
        if game.stopped or not (view.mates or view.silent_mates) or holds_ball:
            return 0.0
        if self._taking and self._last.skill in ("pass", "shoot", "lob", "push", "clear"):
            return _BARRED_S  # it held the ball in the last tick and does not any more
        if not game.free_play and self._fumbled(view) and self._taking:
            return _BARRED_S
        return 0.0 if view.is_at_ball(view.others, _TOUCHED_M) else self._barred_s

    def _fumbled(self, view: View) -> bool:
        """Returns whether the robot has bumped the ball of the set piece away; another may have done so before."""
        laid, ball = self._laid, view.ball.place
        gone, near = laid is not None and math.dist(ball, laid) > _FUMBLED_M, math.dist(view.own.place, ball) < _NEAR_M
        self._moved = self._moved or (gone and not near)
        return gone and near and not self._moved

    def _order(self, view: View, game: Game, job: Job, holds_ball: bool) -> Order:
        if game.paused:
            return Order("stop", intention="pause")
        if not view.localized:
            return Order("search", intention="lost")
        if job.role == GOALKEEPER:
            return self._keep(view, game, holds_ball)
        if not game.free_play:
            return self._set_piece(view, game, job, holds_ball)
        if not view.ball.known:
            return Order("search", job.place, intention="search")
        if holds_ball:
            return self._play_ball(view)
        if job.role == ATTACKER and self._barred_s > 0.0 and not field_players(view):
            return self._await_touch(view)
        if job.role == ATTACKER and not keeper_takes(view, self.field):
            return self._go_for_ball(view)
        return self._help(view, job)

    def _keep(self, view: View, game: Game, holds_ball: bool) -> Order:
        if game.free_play and holds_ball:
            self._drop_late_pass()
            return self._agreed(self._play.relieve(view))
        fetches = game.free_play and view.ball.known and keeper_takes(view, self.field, self._fetches)
        self._fetches = fetches and (self._fetches or not _would_run_into_ball(view, self.field))
        if self._fetches:
            return self._go_for_ball(view)
        furthest_m = KEEPER_OUT_M if game.free_play else BEFORE_LINE_M
        place = Point(furthest_m - self.field.half_length_m, 0.0)
        if not self.field.in_penalty_area(*view.own.place, -1.0, _HOME_M):
            step = self._next_step(view, place, game)
            if step != place:
                return self._stand(view, step, "go home")
        return Order("keep_goal", place, intention="keep goal")

    def _set_piece(self, view: View, game: Game, job: Job, holds_ball: bool) -> Order:
        if job.role != ATTACKER:
            place = self._helper_place(view, game, job)
            return self._stand(view, self._next_step(view, place, game), "take position")
        if game.whose is not Whose.OURS:
            return Order("block", game.spot, intention="keep distance")
        if self.passing.said.passer and not game.stopped:  # the ball is on its way, but not yet in play
            return self._go_for_ball(view)
        if holds_ball and not game.stopped:
            return self._play_ball(view)
        taker = Robot(view.own.name, game.spot, view.own.heading_rad)
        fit = [mate for mate in field_players(view) if self.passing.is_fit(mate, self.field)]
        mates = [] if self._penalty else fit  # a penalty is shot
        if not game.stopped:  # the taker has turned to its receiver
            mates = [mate for mate in mates if mate.name == self._receiver] or mates
        planned = self._plan(view, game)
        near = [mate for mate in mates if mate.role == SUPPORTER] if planned else []
        best = aim.best_pass(taker, near or mates, view.opponents, view.bodies, math.inf, self._receiver)
        told = planned[1] if planned and near else None  # wherever it drives, also too near or too far for a pass
        target = best.place if best else told or self.field.goal_centre(1.0)
        self._receiver = best.receiver if best else near[0].name if near else ""
        self.passing.announce(self._receiver, told or target)
        way_rad = bearing_rad(game.spot, target)
        if game.state is State.KICK_OFF:  # from the own half
            way_rad = clamp(way_rad, -_KICK_OFF_RAD, _KICK_OFF_RAD)
        if game.stopped:
            leaving = any(math.dist(other.place, game.spot) < _LEAVING_M for other in view.opponents)
            place, speed_m_s = formation.taker_place(game.spot, way_rad), _GENTLE_M_S if leaving else 0.0
            return Order("goto", place, way_rad, "take set piece", speed_m_s)
        return Order("get_ball", game.spot, way_rad, "take set piece")

    def _next_step(self, view: View, place: Point, game: Game) -> Point:
        return formation.next_step(view.own.place, place, game, self.field, view.others, view.bodies)

    def _plan(self, view: View, game: Game) -> tuple[str, Point] | None:
        """Returns the variant of the own set piece and the receiver's place, chosen while the game is stopped."""
        if game.number != self._planned_for or (game.stopped and self._blocked_s > _BLOCKED_S):
            if self._rng and game.number != self._planned_for:
                self._turn = int(self._rng.integers(_TURNS))
            self._planned_for, self._blocked_s = game.number, 0.0
            self._planned = set_pieces.choose(game, view.opponents, self.field, view.bodies, self._turn)
        return self._planned

    def _blocked(self, view: View, game: Game) -> bool:
        if self._planned is None:
            return True
        return set_pieces.room_rad(game.spot, self._planned[1], view.opponents, view.bodies) < 0.0

    def _helper_place(self, view: View, game: Game, job: Job) -> Point:
        """Returns the place of a robot that does not take the set piece; the receiver's is told by the taker."""
        told = [mate.agreement.place for mate in view.mates if mate.name == self.passing.said.passer]
        place = told[0] if told and game.whose is Whose.OURS else job.place
        return formation.helper_place(place, game, self.field, bodies=view.bodies)

    def _play_ball(self, view: View) -> Order:
        if self._taking and self._penalty:
            return self._play.take_penalty(view)
        if self._taking and (view.mates or view.silent_mates):
            order = self._play.take_set_piece(view, self._receiver)
            self._receiver = order.receiver or self._receiver
            return self._agreed(order)
        self._drop_late_pass()
        order = self._play.decide(view)
        if order.skill == "dribble":
            self._ask_early(view)
        return self._agreed(order)

    def _drop_late_pass(self) -> None:
        """Looks for another mate if the one that was asked has not accepted in time."""
        if self.passing.late:
            self.passing.drop()

    def _ask_early(self, view: View) -> None:
        """Announces the pass that may follow, so that it need not wait for an answer."""
        likely = self._play.best_pass(view)
        self.passing.announce(*(likely.receiver, likely.place) if likely else ("",))

    def _agreed(self, order: Order) -> Order:
        """Returns the order; a pass for which the receiver does not stand ready yet is aimed, but not played."""
        if order.skill != "pass":
            return order
        self.passing.announce(order.receiver, order.place)
        ready = self.passing.stands or self.passing.late
        return order if ready else order._replace(skill="aim", intention="announce pass")

    def _go_for_ball(self, view: View) -> Order:
        ball = view.ball
        goal_rad = bearing_rad(ball.place, self.field.goal_centre(1.0))
        rolls_free = not view.is_at_ball(view.opponents, HELD_M)
        share = _MEETS_ON if self._last.skill in ("receive", "intercept") else 1.0
        if rolls_free and comes_fast(ball, view.own, share):
            passed = bool(self.passing.said.passer)
            return Order("receive" if passed else "intercept", ball.place, goal_rad, "intercept")
        return Order("get_ball", ball.place, goal_rad, "get ball")

    def _help(self, view: View, job: Job) -> Order:
        if self.passing.said.passer:
            return Order("receive", view.own.place, bearing_rad(view.own.place, view.ball.place), "await pass")
        if job.role == DEFENDER:
            runner = _free_opponent(view, self.field)
            if runner and _nearest_defender(view, runner, _MARK_M):
                return Order("mark", runner.place, bearing_rad(runner.place, view.ball.place), "mark")
        place = self._beside_keeper(view) if job.role == ATTACKER else job.place
        if view.is_at_ball(field_players(view), HELD_M):
            place = formation.beside_shot(view.own.place, place, view.ball.place, self.field)
        return self._stand(view, place, job.role)

    def _beside_keeper(self, view: View) -> Point:
        """Returns the place of an attacker that leaves the ball to its goalkeeper: out of the way of its kick."""
        field, y_m = self.field, view.ball.place.y_m
        _, across = formation.scale(field)
        aside_m = math.copysign(_OFFERS_M[1] * across, view.own.place.y_m - y_m)
        return Point(field.penalty_area_depth_m + _OFFERS_M[0] - field.half_length_m, y_m + aside_m)

    def _await_touch(self, view: View) -> Order:
        """Returns the order of the only field player after its set piece: it guards the ball until it is touched."""
        ball = view.ball.place
        place = ahead(ball, bearing_rad(ball, self.field.goal_centre(-1.0)), _GUARD_M)
        return self._stand(view, place, "await touch")

    def _stand(self, view: View, place: Point, intention: str) -> Order:
        return Order("goto", place, bearing_rad(place, view.ball.place), intention)


def keeper_takes(view: View, field: Field, goes_on: bool = False) -> bool:
    """Returns whether the goalkeeper leaves its line: for a slow ball before its goal that it reaches first.

    `goes_on`: it has left its line, and does not turn back for less than it would take to leave it.
    """
    ball = view.ball
    within_m = _FETCHED_M + _GOES_ON_M * goes_on
    if ball.speed_m_s > _FAST_BALL_M_S + _GOES_ON_M_S * goes_on or not field.in_penalty_area(
        *ball.place, -1.0, within_m
    ):
        return False
    keepers = [robot for robot in (view.own, *view.mates) if robot.role == GOALKEEPER]
    if not keepers:
        return False
    others = [*view.opponents, *(robot for robot in (view.own, *view.mates) if robot.role != GOALKEEPER)]
    course = ballistics.Course(ball, view.bodies)
    keeper_s = course.meet(keepers[0].place, keepers[0].velocity_m_s).time_s
    later_s = _SOONER_S + _GOES_ON_S * goes_on
    return all(keeper_s < course.meet(other.place, other.velocity_m_s).time_s + later_s for other in others)


def _would_run_into_ball(view: View, field: Field) -> bool:
    """Returns whether the goalkeeper comes home too fast to stop before a ball that lies nearer to the goal."""
    own, ball = view.own, view.ball
    way_rad, away_m = bearing_rad(own.place, ball.place), math.dist(own.place, ball.place)
    towards_m_s = own.velocity_m_s.x_m * math.cos(way_rad) + own.velocity_m_s.y_m * math.sin(way_rad)
    stops_m = max(0.0, towards_m_s) ** 2 / (2 * _STOPS_M_S2)
    return view.ball_is_nearer_to(field.goal_centre(-1.0)) and stops_m > away_m - view.bodies.beside_m


def leave_field(view: View, game: Game, field: Field) -> Order:
    """Returns the order of a robot that was sent off: over the nearer touch line, and to wait there.

    Its way keeps the distance to the ball of a set piece.
    """
    own, bench_m = view.own.place, field.half_length_m - _BENCH_M
    place = Point(clamp(own.x_m, -bench_m, bench_m), math.copysign(field.half_width_m + field.border_m / 2, own.y_m))
    if game.state.is_set_piece:
        place = formation.next_step(own, place, game, field, view.others, view.bodies)
    return Order("goto", place, view.own.heading_rad, "leave the field")


def _nearest_defender(view: View, runner: Robot, limit_m: float) -> bool:
    """Returns whether the own robot marks an opponent: it is within the limit, and no other defender is nearer."""
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

"""Decision of the robot that has the ball: shoot, pass, set the ball free, or take it along."""

import math
from collections.abc import Sequence

from procs.behaviour import aim, formation
from procs.behaviour.order import Order
from procs.behaviour.passing import Passing
from procs.behaviour.roles import GOALKEEPER
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad
from procs.model.robot import ABSENT

_SHOT_RANGE_M = 10.5
_HALFWAY_M = 0.3  # a goal from the own half would not count
_LOB_RAD = 0.05  # room beside a robot that a lob must have
_ROOM_MAKER_M = 8.0  # so near to the goal a robot rather makes room for a shot than drives on
_MOUTH_RAD = 0.16  # from where the goal looks narrower, a shot would hit the post
_ROOM_M = 0.15  # beside a shot's way at the goal ...
_ROOM_PRESSED_M = 0.05  # ... or less before the ball is lost
_FAR_M, _ROOM_FAR_M = 6.0, 0.4  # a keeper reaches shots from further away that have less room; a lob is better
_CROSS_M = 8.0  # a mate so near to the goal gets the ball without delay
_CLOSE_M = 3.0  # if a rival is so near
_MARKED_M = 1.0  # a mate with a rival so near gets no pass in free play
_BACK_M = 1.0  # a pass may lose so much ground ...
_FAR_BACK_M = 4.0  # ... or so much, if the ball must go
_PRESSED_M, _PRESSED_S = 1.3, 0.6  # a rival so near, or in so short a time, presses the robot
_DANGER_M = -4.0  # further back on the usual field, so near to the own goal, a pressed robot rather clears the ball
_PATIENCE_S = 2.5  # with the ball, then a poorer shot or a pass will do
_STUCK_S, _STUCK_M = 0.6, 0.3  # a ball that gets no further must go before the robot holds it for too long
_FREE_S = 0.3  # a ball that is lost for longer is set free
_DRIBBLE_M = 1.0  # then a poorer shot or a pass will do ...
_RELEASE_M = 1.2  # ... and then the ball must go; the rules allow 3 m, and braking takes its way
_LONGEST_M = 2.3  # a dribble ends so far from where the robot took the ball
_GENTLE_M_S = 2.2  # arrival of a pass from a set piece, whose receiver has time
_PUSH_M, _PUSH_M_S = 3.0, 1.2  # way of a push, and speed of the ball at its end
_SLOW_BALL_M_S = 2.5  # mean speed of a dribbled or pushed ball
_CLEARING_RAD = (0.0, 0.4, -0.4, 0.8, -0.8, 1.2, -1.2)  # directions of a clearance
_CLEARED_M = 6.0  # and the way that should be free
_UPFIELD_1_M = 0.03  # a metre gained before the ball is out is worth so much
_AIMED_M = 1.5  # a clearance is aimed at a point so near: roughly
_WAYS_RAD = (0.0, 0.4, -0.4, 0.8, -0.8, 1.2, -1.2)  # directions of a dribble, off the way to the goal
_DETOUR_RAD = 0.3  # a radian off the way to the goal costs so much free path
_ASIDE_M = 1.2  # way to a place with more room for a shot
_ASIDE_RAD = (0.0, 0.7, -0.7, 1.3, -1.3)  # directions to such a place, off the way to the goal
_CARRIED_M = 2.3  # way of a dribble
_BEFORE_GOAL_M = 2.5  # robots with the ball keep that distance from the goal line
_COMMITTED_S = 1.6  # the robot keeps for so long to a kick that it has begun, unless the way gets blocked


class BallPlay:
    """Decides for one robot, in the ticks in which it has the ball; keeps a decision until the ball is gone."""

    def __init__(self, field: Field, passing: Passing) -> None:
        self.field = field
        self._passing = passing
        self._held_s = 0.0
        self._held_from: Point | None = None
        self._free_s = 0.0
        self._kick: Order | None = None
        self._kick_s = 0.0
        self._dribble_rad = math.nan
        self._room_at: Point | None = None

    def watch(self, view: View, holds_ball: bool, duration_s: float) -> None:
        """Takes the ball's state of this tick, `duration_s` after the last."""
        self._held_s = self._held_s + duration_s if holds_ball else 0.0
        self._free_s = 0.0 if holds_ball else self._free_s + duration_s
        self._kick_s += duration_s
        if self._free_s > _FREE_S:
            self._held_from, self._kick, self._dribble_rad, self._room_at = None, None, math.nan, None
        elif holds_ball:
            self._held_from = self._held_from or view.ball.place

    def decide(self, view: View) -> Order:
        """Returns the order in free play."""
        kept = self._keep(view) if self._kick_s < _COMMITTED_S else None
        order = kept or self._choose(view)
        kicks = order is not None and order.skill in ("shoot", "lob", "pass", "push", "clear")
        if kicks and not kept:
            self._kick_s = 0.0
        self._kick = order if kicks else None
        return order or self._dribble(view)

    def take_set_piece(self, view: View, receiver: str) -> Order:
        """Returns the order of a set piece's taker: a pass, above all to the mate to which the robot has turned."""
        agreed = [mate for mate in field_players(view) if mate.name == receiver]
        order = self._pass(view, agreed, math.inf, 0.0, receiver)
        order = order and order._replace(speed_m_s=_GENTLE_M_S)
        for lane_rad in (aim.LANE_RAD, 0.0):
            order = order or self._pass(view, field_players(view), math.inf, lane_rad, receiver)
        return order or (self._clear(view) if field_players(view) else self._set_free(view))

    def _set_free(self, view: View) -> Order:
        """Returns the order of a taker that has no field player to pass to: the ball stays in play, near the robot."""
        if self._is_near_own_goal(view.ball.place):
            return self._clear(view)
        if self._kick is None or self._kick.skill != "push" or self._kick_s > _COMMITTED_S:
            self._kick, self._kick_s = self._push(view), 0.0
        return self._kick

    def take_penalty(self, view: View) -> Order:
        """Returns the order of a penalty's taker."""
        if self._kick is None or self._kick_s > _COMMITTED_S:
            self._kick, self._kick_s = self._penalty(view), 0.0
        return self._kick

    def _penalty(self, view: View) -> Order:
        return self._kick_at_goal(view, _ROOM_M) or self._shot(view, 0.0) or self._clear(view)

    def best_pass(self, view: View) -> Order | None:
        """Returns the pass that the robot would play if it had to play one now."""
        return self._pass_on(view, _BACK_M)

    def relieve(self, view: View) -> Order:
        """Returns the order of a goalkeeper with the ball."""
        return self._pass_on(view, back_m=0.0) or self._clear(view)

    def _choose(self, view: View) -> Order | None:
        pressed = any(_presses(other, view.own.place) for other in view.opponents)
        carried_m = math.dist(self._held_from, view.ball.place) if self._held_from else 0.0
        stuck = self._held_s > _STUCK_S and carried_m < _STUCK_M
        impatient = stuck or self._held_s > _PATIENCE_S or carried_m > _DRIBBLE_M
        order = self._kick_at_goal(view, _ROOM_PRESSED_M if pressed or impatient else _ROOM_M) or self._cross(view)
        alone = all(math.dist(other.place, view.own.place) > _CLOSE_M for other in view.opponents)
        if order is None and (pressed or impatient):
            order = None if alone else self._pass_on(view, _BACK_M)
        in_danger = pressed and (self._is_near_own_goal(view.own.place) or self._held_s > _PATIENCE_S)
        if order is None and (in_danger or self._held_s > 2 * _PATIENCE_S):
            order = self._clear(view)
        if order is None and (stuck or carried_m > _RELEASE_M):
            order = (None if alone else self._pass_on(view, _FAR_BACK_M)) or self._push(view)
        return order

    def _is_near_own_goal(self, place: Point) -> bool:
        along, _ = formation.scale(self.field)
        return place.x_m < _DANGER_M * along

    def _keep(self, view: View) -> Order | None:
        """Returns the kick that was begun, with a pass to where its receiver is now; None if its way is blocked."""
        kick = self._kick
        if kick is None or kick.intention == "clear":
            return kick
        if kick.intention == "pass":
            mates = [mate for mate in _unmarked(view, field_players(view)) if mate.name == kick.receiver]
            return self._pass(view, mates, math.inf, 0.0, kick.receiver)
        if kick.intention == "lob":
            return kick if aim.best_lob(view.ball.place, view.others, self.field, view.bodies).free_rad > 0.0 else None
        return kick if aim.lane_rad(view.ball.place, kick.place, view.opponents, view.bodies) > 0.0 else None

    def _dribble(self, view: View) -> Order:
        """Takes the ball along where the way is free, towards the goal if possible."""
        ball, goal = view.ball.place, self.field.goal_centre(1.0)
        start = self._held_from or ball
        goal_rad = bearing_rad(ball, goal)
        if math.dist(ball, goal) < _ROOM_MAKER_M:
            return self._make_room(view, goal_rad)
        ways = [goal_rad + turn_rad for turn_rad in _WAYS_RAD]
        inside = [way_rad for way_rad in ways if self._may_carry(ahead(ball, way_rad, _CARRIED_M))] or ways[:1]

        def worth(way_rad: float) -> float:
            place, rivals = ahead(ball, way_rad, _CARRIED_M), view.opponents
            free_rad = min(0.6, aim.lane_rad(ball, place, rivals, view.bodies, _SLOW_BALL_M_S))
            kept = not math.isnan(self._dribble_rad) and abs(wrap_rad(way_rad - self._dribble_rad)) < 0.25
            return free_rad - _DETOUR_RAD * abs(wrap_rad(way_rad - goal_rad)) + 0.2 * kept

        self._dribble_rad = max(inside, key=worth)
        target = ahead(ball, self._dribble_rad, _CARRIED_M)
        if math.dist(start, target) > _LONGEST_M:
            target = ahead(start, bearing_rad(start, target), _LONGEST_M)
        return Order("dribble", target, bearing_rad(target, goal), "dribble")

    def _make_room(self, view: View, goal_rad: float) -> Order:
        """Takes the ball to where a shot or a lob has the most room, mostly sideways, mouth towards the goal."""
        ball, others, bodies = view.ball.place, view.others, view.bodies
        start = self._held_from or ball
        places = [ahead(ball, goal_rad + turn_rad, _ASIDE_M) for turn_rad in _ASIDE_RAD]
        possible = [place for place in places if self._may_carry(place) and math.dist(start, place) < _LONGEST_M]

        def room_rad(place: Point) -> float:
            kept = math.dist(place, self._room_at) < _ASIDE_M if self._room_at else False
            shot, lob = (best(place, others, self.field, bodies).free_rad for best in (aim.best_shot, aim.best_lob))
            return max(shot, lob) + 0.1 * kept

        self._room_at = max(possible, key=room_rad, default=ball)
        target = aim.best_shot(self._room_at, others, self.field, bodies).place
        return Order("dribble", self._room_at, bearing_rad(self._room_at, target), "make room")

    def _may_carry(self, place: Point) -> bool:
        field = self.field
        return field.in_field(*place, -0.5) and place.x_m < field.half_length_m - _BEFORE_GOAL_M

    def _kick_at_goal(self, view: View, room_m: float) -> Order | None:
        far = math.dist(view.ball.place, self.field.goal_centre(1.0)) > _FAR_M
        return self._shot(view, _ROOM_FAR_M if far else room_m) or self._lob(view) or self._shot(view, room_m)

    def _shot(self, view: View, room_m: float) -> Order | None:
        start = view.ball.place
        if not self._in_range(start):
            return None
        best = aim.best_shot(start, view.others, self.field, view.bodies)
        if best.free_rad * math.dist(start, best.place) < room_m:
            return None
        return Order("shoot", best.place, bearing_rad(start, best.place), "shoot")

    def _lob(self, view: View) -> Order | None:
        """Kicks over the robots and under the bar."""
        start = view.ball.place
        if not self._in_range(start):
            return None
        best = aim.best_lob(start, view.others, self.field, view.bodies)
        if best.free_rad < _LOB_RAD:
            return None
        return Order("lob", best.place, bearing_rad(start, best.place), "lob")

    def _in_range(self, start: Point) -> bool:
        near = start.x_m > _HALFWAY_M and math.dist(start, self.field.goal_centre(1.0)) < _SHOT_RANGE_M
        return near and self._mouth_rad(start) > _MOUTH_RAD

    def _mouth_rad(self, start: Point) -> float:
        right, left = (bearing_rad(start, post) for post in self.field.goal_posts(1.0))
        return abs(wrap_rad(left - right))

    def _cross(self, view: View) -> Order | None:
        """Passes to a mate that can shoot, if the own robot is further from the goal."""
        goal = self.field.goal_centre(1.0)
        own_m = math.dist(view.ball.place, goal)
        if all(math.dist(other.place, view.own.place) > _CLOSE_M for other in view.opponents):
            return None
        mates = [
            mate
            for mate in _unmarked(view, field_players(view))
            if math.dist(mate.place, goal) < min(_CROSS_M, own_m - 1.0) and self._mouth_rad(mate.place) > _MOUTH_RAD
        ]
        return self._pass(view, mates, math.inf, aim.LANE_RAD, "")

    def _clear(self, view: View) -> Order:
        """Kicks the ball away hard: upfield, where the way is free and the robot need not turn far."""
        ball, own_rad = view.ball.place, view.own.heading_rad

        def worth(way_rad: float) -> float:
            free_rad = aim.lane_rad(ball, ahead(ball, way_rad, _CLEARED_M), view.others, view.bodies)
            turn_rad = abs(wrap_rad(way_rad - own_rad))
            return min(0.3, free_rad) - aim.TURN_1_RAD * turn_rad + _UPFIELD_1_M * self._upfield_m(ball, way_rad)

        way_rad = max(_CLEARING_RAD, key=worth)
        return Order("clear", ahead(ball, way_rad, _AIMED_M), way_rad, "clear")

    def _upfield_m(self, ball: Point, way_rad: float) -> float:
        """Returns how much ground a clearance gains before it leaves the field over a touch line, at most 10 m."""
        beside_m = self.field.half_width_m - math.copysign(1.0, math.sin(way_rad)) * ball.y_m
        return min(10.0, max(0.0, beside_m) / max(1e-3, abs(math.tan(way_rad))))

    def _push(self, view: View) -> Order:
        """Sets the ball free, so that the robot can take it again: a slow pass ahead, where the way is free."""
        start = view.ball.place
        goal_rad = bearing_rad(start, self.field.goal_centre(1.0))
        places = [ahead(start, goal_rad + turn_rad, _PUSH_M) for turn_rad in (0.0, 0.5, -0.5, 1.0, -1.0)]
        inside = [place for place in places if self.field.in_field(*place, -0.5)] or places[:1]

        def room_rad(place: Point) -> float:
            return min(0.6, aim.lane_rad(start, place, view.others, view.bodies, _SLOW_BALL_M_S))

        best = max(inside, key=room_rad)
        return Order("push", best, bearing_rad(start, best), "push", _PUSH_M_S)

    def _pass_on(self, view: View, back_m: float) -> Order | None:
        return self._pass(view, _unmarked(view, field_players(view)), back_m, aim.LANE_RAD, "")

    def _pass(self, view: View, mates: Sequence[Robot], back_m: float, lane_rad: float, kept: str) -> Order | None:
        asked = [mate for mate in mates if self._passing.may_ask(mate) and self._passing.is_fit(mate, self.field)]
        kept = kept or self._passing.said.receiver
        best = aim.best_pass(view.own, asked, view.opponents, view.bodies, back_m, kept)
        if best is None or best.free_rad < lane_rad:
            return None
        heading_rad = bearing_rad(view.own.place, best.place)
        return Order("pass", best.place, heading_rad, "pass", receiver=best.receiver)


def _presses(rival: Robot, place: Point) -> bool:
    way_rad = bearing_rad(rival.place, place)
    closing_m_s = rival.velocity_m_s.x_m * math.cos(way_rad) + rival.velocity_m_s.y_m * math.sin(way_rad)
    return math.dist(rival.place, place) - _PRESSED_S * max(0.0, closing_m_s) < _PRESSED_M


def _unmarked(view: View, mates: Sequence[Robot]) -> list[Robot]:
    return [mate for mate in mates if all(math.dist(mate.place, other.place) > _MARKED_M for other in view.opponents)]


def field_players(view: View) -> list[Robot]:
    """Returns the mates in play, without the goalkeeper."""
    return [mate for mate in view.mates if mate.role not in (GOALKEEPER, ABSENT)]

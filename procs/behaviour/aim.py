"""Targets of shots and passes, by the room beside the robots in the way."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from procs.behaviour import ballistics
from procs.behaviour.bodies import Bodies
from procs.behaviour.view import Robot
from procs.model.field import Field, Point
from procs.model.geometry import bearing_rad, wrap_rad

_REACTION_S, _STEP_ASIDE_M_S = 0.25, 0.8  # a robot begins to step into the ball's way so late, and gets there so fast
_BALL_M_S = 9.0  # mean speed of a shot
_TARGETS, _INSIDE_M = (
    13,
    0.15,
)  # points on the goal line for a shot, the outermost so far inside the posts
_LOB_INSIDE_M = 0.5  # lobs are aimed so far inside the posts
_OVER_M = 0.06  # by which a lob passes over a robot, as the kicker's speed is not exact
_LOB_TARGETS = 5
_SOON_S = 0.2  # from the view until a lob passes a robot nearby
_LOB_RAD = 0.1  # more room beside the robots before the rising ball is not needed
LANE_RAD = 0.12
"""Room beside a pass's way that is enough."""
_PASS_M_S = 4.3  # mean speed of a pass
_NEAREST_M, _FURTHEST_M = 2.0, 9.0  # way of a pass
_MOST_RAD = 0.4  # a free angle beyond that is worth no more
_LEAD_S = 0.5  # a mate is assumed to drive on for this time
_GAIN_1_M = 0.06  # a metre gained is worth as much as this angle of free path in rad
TURN_1_RAD = 0.15
"""Angle of free path that a radian of turning costs."""
_ROOM_1_M, _ROOM_M = 0.06, 5.0  # value in rad of a metre between the receiver and its nearest rival, and how many count
_KEPT_RAD = 0.2  # a receiver is kept unless another is so much better


class Aim(NamedTuple):
    """A point to play the ball to, and the room there."""

    place: Point
    free_rad: float
    """Smallest angle between the ball's path and an obstacle, post or robot; negative: blocked."""
    receiver: str = ""
    """Mate for whom a pass is meant."""


def lane_rad(start: Point, end: Point, robots: Iterable[Robot], bodies: Bodies, ball_m_s: float = _BALL_M_S) -> float:
    """Returns the free angle beside the way of a ball; negative if a robot blocks it, pi without a robot nearby.

    A robot far down the way has time to step aside and counts as wider.
    """
    way_m, way_rad = math.dist(start, end), bearing_rad(start, end)
    free_rad, beside_m = math.pi, bodies.beside_m
    for robot in robots:
        distance_m = math.dist(start, robot.place)
        if distance_m > way_m + beside_m:
            continue
        off_rad = abs(wrap_rad(bearing_rad(start, robot.place) - way_rad))
        width_m = beside_m + _STEP_ASIDE_M_S * max(0.0, distance_m / ball_m_s - _REACTION_S)
        free_rad = min(free_rad, off_rad - math.asin(min(1.0, width_m / max(distance_m, 1e-6))))
    return free_rad


def best_shot(start: Point, robots: Iterable[Robot], field: Field, bodies: Bodies) -> Aim:
    """Returns the point of the opponents' goal line with the most room, seen from the ball at `start`."""
    in_the_way = list(robots)
    posts = field.goal_posts(1.0)
    post_m = field.post_diameter_m / 2 + bodies.ball_radius_m
    inner_m = field.goal_width_m / 2 - _INSIDE_M
    best = Aim(field.goal_centre(1.0), -math.pi)
    for index in range(_TARGETS):
        target = Point(field.half_length_m, inner_m * (2 * index / (_TARGETS - 1) - 1))
        way_rad = bearing_rad(start, target)
        post_rad = min(
            abs(wrap_rad(bearing_rad(start, post) - way_rad)) - post_m / max(post_m, math.dist(start, post))
            for post in posts
        )
        free_rad = min(post_rad, lane_rad(start, target, in_the_way, bodies))
        if free_rad > best.free_rad:
            best = Aim(target, free_rad)
    return best


def best_lob(start: Point, robots: Iterable[Robot], field: Field, bodies: Bodies) -> Aim:
    """Returns the point of the opponents' goal line for a lob, and the room beside the robots that can block it.

    A robot, where it will be in a moment, blocks a lob only where the ball has not risen above it yet. Of targets with
    enough room the one furthest from the other robots is best, as a lob that falls short is a shot. There is no room
    for a lob that the kicker cannot kick.
    """
    goal = field.goal_centre(1.0)
    lob = ballistics.lob(math.dist(start, goal), bodies)
    if not lob.is_possible(bodies):
        return Aim(goal, -math.pi)
    near_m = lob.clear_m(bodies.robot_height_m + _OVER_M) + bodies.beside_m
    others = list(robots)
    near = [robot._replace(place=_soon(robot)) for robot in others if math.dist(start, robot.place) < near_m]
    deep = [robot for robot in others if math.dist(start, robot.place) >= near_m]
    inner_m = field.goal_width_m / 2 - _LOB_INSIDE_M

    def room_rad(target: Point) -> tuple[float, float]:
        return min(_LOB_RAD, lane_rad(start, target, near, bodies)), lane_rad(start, target, deep, bodies)

    shares = (2 * index / (_LOB_TARGETS - 1) - 1 for index in range(_LOB_TARGETS))
    best = max((Point(field.half_length_m, inner_m * share) for share in shares), key=room_rad)
    return Aim(best, room_rad(best)[0])


def _soon(robot: Robot) -> Point:
    (x_m, y_m), (vx_m_s, vy_m_s) = robot.place, robot.velocity_m_s
    return Point(x_m + _SOON_S * vx_m_s, y_m + _SOON_S * vy_m_s)


def best_pass(
    player: Robot,
    mates: Iterable[Robot],
    opponents: Iterable[Robot],
    bodies: Bodies,
    back_m: float = 1.0,
    kept: str = "",
) -> Aim | None:
    """Finds the mate for the best pass: a free way, ground gained, little turning of the player.

    `kept` is the receiver of the last tick, if the player has turned to it.

    Returns:
        Expected place of that mate, and the room beside the way; None without a mate that will be 2 to 9 m away and at
        most `back_m` behind the player.
    """
    others = list(opponents)
    best: tuple[tuple[bool, float], Aim] | None = None
    for mate in mates:
        lead_s = min(_LEAD_S, math.dist(player.place, mate.place) / _PASS_M_S)
        place = Point(mate.place.x_m + lead_s * mate.velocity_m_s.x_m, mate.place.y_m + lead_s * mate.velocity_m_s.y_m)
        gain_m = place.x_m - player.place.x_m
        if not _NEAREST_M <= math.dist(player.place, place) <= _FURTHEST_M or gain_m < -back_m:
            continue
        free_rad = lane_rad(player.place, place, others, bodies, _PASS_M_S)
        turn_rad = abs(wrap_rad(bearing_rad(player.place, place) - player.heading_rad))
        worth = min(free_rad, _MOST_RAD) + _GAIN_1_M * gain_m - TURN_1_RAD * turn_rad + _KEPT_RAD * (mate.name == kept)
        worth += _ROOM_1_M * min(_ROOM_M, min((math.dist(place, other.place) for other in others), default=_ROOM_M))
        rank = (free_rad >= (0.0 if mate.name == kept else LANE_RAD), worth)
        if best is None or rank > best[0]:
            best = rank, Aim(place, free_rad, mate.name)
    return best[1] if best else None

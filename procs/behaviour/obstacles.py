"""Areas that the robot's middle avoids: other robots, goal posts, and on demand the ball; world frame."""

import math
from collections.abc import Iterable, Mapping

from lcmtypes.soccer import robot_estimate_t, world_model_t
from procs.behaviour.bodies import Bodies
from procs.behaviour.motion import Limits, speed_to_go_m_s
from procs.behaviour.path import Disc
from procs.behaviour.velocity_obstacles import DRIVES_M_S, Mover
from procs.behaviour.view import Estimate, is_sane
from procs.model.field import SIDES, Field, Point
from procs.model.geometry import bearing_rad, clamp, plausible
from procs.model.robot import PLAYERS, Player, number_of_mate

_MARGIN_M = 0.12  # room beside a robot that is driven around
_GAP_M = 0.06  # between two robots that nearly touch
_BALL_MARGIN_M = 0.1  # room beside a ball that is avoided
_POST_MARGIN_M = 0.03  # room beside a goal post
_BEFORE_GOAL_M = 0.1  # targets in or behind a goal move so far before the goal line
_FORESIGHT_S = 0.8  # robots are avoided where they will be, at most so much later
_MEETING_M_S = 3.0  # two robots that drive towards each other get closer about so fast
_NEAR_M = 6.0  # further obstacles do not matter yet
_PASSING_M = 0.1  # room beside a robot that is passed ...
_UNSURE_M = 0.15  # ... and at most so much more for the deviation of its place
_OFF_WALL_M = 0.1  # room between a robot at its target and the wall
_OFF_GOAL_M = 0.5  # beside the mouth of a goal, robots keep before its line, too
_AT_WALL_M = 0.05  # error of the believed place of a robot at the wall


def apart_m(bodies: Bodies) -> float:
    """Returns the distance of the middles of two robots that nearly touch."""
    return 2 * bodies.robot_radius_m + _GAP_M


def discs(model: world_model_t, field: Field, bodies: Bodies, avoid_robots: bool, avoid_ball: bool) -> list[Disc]:
    """Returns discs around near obstacles, at their positions in a moment."""
    own, robot_m = Point(model.x_m, model.y_m), bodies.robot_radius_m
    found = [
        Disc(post, robot_m + field.post_diameter_m / 2 + _POST_MARGIN_M)
        for side in SIDES
        for post in field.goal_posts(side)
    ]
    if avoid_robots:
        found += _robots([*model.mates, *_strangers(model)], own, robot_m)
    if avoid_ball and model.ball.known and plausible(model.ball.x_m, model.ball.y_m):
        ball = Point(model.ball.x_m, model.ball.y_m)
        found.append(Disc(ball, robot_m + bodies.ball_radius_m + _BALL_MARGIN_M))
    return [disc for disc in found if math.dist(disc.middle, own) < _NEAR_M]


def reachable(place: Point, field: Field, bodies: Bodies) -> Point:
    """Returns the place, or the nearest one that is neither in a goal nor at the wall."""
    off_m = bodies.robot_radius_m + _OFF_WALL_M
    x_m = clamp(place.x_m, -field.half_length_m - field.border_m + off_m, field.half_length_m + field.border_m - off_m)
    y_m = clamp(place.y_m, -field.half_width_m - field.border_m + off_m, field.half_width_m + field.border_m - off_m)
    if _is_before_goal(y_m, field):
        x_m = clamp(x_m, -field.half_length_m + _BEFORE_GOAL_M, field.half_length_m - _BEFORE_GOAL_M)
    return Point(x_m, y_m)


def is_in_goal(place: Point, field: Field) -> bool:
    """Returns whether a place is in a goal, beside its net or behind it; robots stay before the goal line there."""
    return abs(place.x_m) > field.half_length_m and _is_before_goal(place.y_m, field)


def _is_before_goal(y_m: float, field: Field) -> bool:
    return abs(y_m) < field.goal_width_m / 2 + _OFF_GOAL_M


def inside_walls(place: Point, field: Field, bodies: Bodies) -> bool:
    """Returns whether a robot's middle can be at the place, as the wall around the field allows."""
    return min(_room_m(place, field, bodies)) > -_AT_WALL_M


def touches_wall(place: Point, field: Field, bodies: Bodies) -> bool:
    """Returns whether a robot with its middle at the place may touch the wall around the field."""
    return min(_room_m(place, field, bodies)) < _AT_WALL_M


def braked_at_walls(velocity_m_s: Point, place: Point, field: Field, bodies: Bodies, braking_m_s2: float) -> Point:
    """Returns the velocity, limited towards each wall to what a robot at the place can still brake."""
    vx_m_s, vy_m_s = velocity_m_s
    limits_m_s = [
        math.sqrt(2 * braking_m_s2 * max(0.0, room_m - _AT_WALL_M)) for room_m in _room_m(place, field, bodies)
    ]
    back_m_s, ahead_m_s, right_m_s, left_m_s = limits_m_s
    return Point(clamp(vx_m_s, -back_m_s, ahead_m_s), clamp(vy_m_s, -right_m_s, left_m_s))


def braked_at_disc(velocity_m_s: Point, place: Point, disc: Disc, limits: Limits) -> Point:
    """Returns the velocity, limited towards the middle of a disc to what a robot at the place can still brake."""
    room_m, way_rad = math.dist(place, disc.middle) - disc.radius_m, bearing_rad(place, disc.middle)
    cos, sin = math.cos(way_rad), math.sin(way_rad)
    towards_m_s = velocity_m_s.x_m * cos + velocity_m_s.y_m * sin
    excess_m_s = max(0.0, towards_m_s - speed_to_go_m_s(room_m, 0.0, math.inf, limits))
    return Point(velocity_m_s.x_m - excess_m_s * cos, velocity_m_s.y_m - excess_m_s * sin)


def _room_m(place: Point, field: Field, bodies: Bodies) -> tuple[float, float, float, float]:
    """Returns the room of a robot to the walls in the west, east, south and north; negative beyond a wall."""
    x_m = field.half_length_m + field.border_m - bodies.robot_radius_m
    y_m = field.half_width_m + field.border_m - bodies.robot_radius_m
    return x_m + place.x_m, x_m - place.x_m, y_m + place.y_m, y_m - place.y_m


def movers(
    model: world_model_t, latency_s: float, own_number: int = 0, players: Mapping[str, Player] = PLAYERS
) -> list[Mover]:
    """Returns the other robots where they will be when the robot begins to follow its next command.

    Of two mates the one with the higher number gives way.
    """
    mates = [
        _mover(mate, latency_s, number_of_mate(mate, players) > own_number) for mate in model.mates if is_sane(mate)
    ]
    return mates + [_mover(other, latency_s, False) for other in _strangers(model) if is_sane(other)]


def _strangers(model: world_model_t) -> list[robot_estimate_t]:
    """Returns the robots that tell nothing: opponents, and mates that are only seen."""
    return [*model.opponents, *model.silent_mates]


def _mover(robot: Estimate, latency_s: float, gives_way: bool) -> Mover:
    return Mover(
        Point(robot.x_m + robot.vx_m_s * latency_s, robot.y_m + robot.vy_m_s * latency_s),
        Point(robot.vx_m_s, robot.vy_m_s),
        gives_way=gives_way and math.hypot(robot.vx_m_s, robot.vy_m_s) > DRIVES_M_S,
        margin_m=_PASSING_M + _deviation_m(robot),
    )


def _deviation_m(robot: Estimate) -> float:
    (xx_m2, _), (_, yy_m2) = robot.covariance_m2
    return min(_UNSURE_M, math.sqrt(max(0.0, xx_m2, yy_m2)))


def _robots(estimates: Iterable[Estimate], own: Point, robot_m: float) -> list[Disc]:
    found = []
    for robot in estimates:
        if not is_sane(robot):
            continue
        ahead_s = min(_FORESIGHT_S, math.dist(own, (robot.x_m, robot.y_m)) / _MEETING_M_S)
        middle = Point(robot.x_m + robot.vx_m_s * ahead_s, robot.y_m + robot.vy_m_s * ahead_s)
        found.append(Disc(middle, 2 * robot_m + _MARGIN_M, 2 * robot_m))
    return found

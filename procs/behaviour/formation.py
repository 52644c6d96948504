"""Places of the robots without the ball, relative to the ball; attack frame."""

import math
from collections.abc import Sequence

from procs.behaviour.bodies import USUAL, Bodies
from procs.behaviour.game import Game, Whose
from procs.behaviour.path import Disc
from procs.behaviour.shortest import first_turn
from procs.behaviour.view import Robot
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.geometry import ahead, bearing_rad, between, clamp

_OWN_SET_PIECE_M, _THEIR_SET_PIECE_M, _DROPPED_BALL_M = 2.3, 3.3, 1.3
"""Distances from the ball of a set piece: those of the rules and 0.3 m more."""
_PASSES_M, _TOO_NEAR_M = 0.1, 0.15  # a robot passes the circle, or is too near and leaves it, so much nearer
_TAKER_M = 0.75  # from the middle of a waiting taker to the ball
_LAYOFF_M, _LAYOFF_RAD = 2.4, (0.55, 0.8, 1.1, 1.5, 1.9, 2.3)
"""Distance of the receiver from the ball of the own set piece, and its least angle off the straight way back."""
_AREA_M = 0.35
"""Robots without the ball keep that distance from the penalty areas."""
_APART_M, _BESIDE_M = 1.0, 0.1
"""Least distance of two places, and of two bodies at them, which decides for large robots."""
_OFF_WALL_M = 0.1  # between a body at a place and the wall
_FURTHER_M = 0.5  # where all places at a distance from the ball are taken, the next ones are so much further away
_TURNS_RAD = [sign * 0.15 * step for step in range(1, 21) for sign in (1, -1)]
_LENGTH_M, _WIDTH_M = 22.0, 14.0
"""Field for which the distances of formations are; they become larger or smaller with the field."""
_BACK_M, _STOPPER_M = 0.75, 0.95  # before the own penalty area: the furthest place back, and the nearest to the goal
_SHOOTER_M, _SHOOTER_Y_M = 1.75, 2.5  # a mate so far before the opponents' penalty area, and so far aside, can shoot
_BESIDE_FIELD_M = 0.3  # a robot at the side of the field may stand so far outside
_PASSED_M = 0.2  # between the bodies of a robot and one that it passes
_STANDS_M_S = 0.3  # a slower robot stays where it is
_STEP_M = 1.5  # far enough ahead that the robot does not brake
_SHOT_M, _BESIDE_SHOT_M = 8.0, 1.2
"""Distance from which a mate with the ball shoots, and distance of the others from the way to the goal's middle."""
_HALFWAY_M = 0.5
"""At a kick-off a robot's middle stays that far in its own half."""
_ROW_M, _ROW_BACK_M, _ROW_Y_M = 1.5, 5.0, 4.0
"""Further robots of a large team: from one row to the next, from the ball to the first row, and beside the middle."""
_SHIFT_M, _TOUCH_LINE_M = 1.5, 0.5  # a place that is taken moves aside so far, and stays inside the touch lines


def places(ball: Point, ours: bool, flank: float, field: Field) -> list[Point]:
    """Returns the places of supporter, first and second defender, and one more robot, most important first.

    `ours`: the team has the ball or will have it sooner; the supporter then offers itself ahead of the ball,
    on its flank: -1 or 1.
    """
    goal, (along, across) = field.goal_centre(-1.0), scale(field)
    back_m = before_area_m(field, _BACK_M)
    shooter_m, shooter_aside_m = before_area_m(field, _SHOOTER_M), _SHOOTER_Y_M * across
    if ours:
        x_m = clamp(ball.x_m + 3.0 * along, -5.0 * along, shooter_m)
        aside_m = shooter_aside_m if x_m > 3.0 * along else 5.0 * across  # near the goal its mouth has to look wide
        supporter = Point(x_m, clamp(ball.y_m + flank * (3.5 * across), -aside_m, aside_m))
    else:
        aside_m = 5.0 * across
        y_m = clamp(ball.y_m * 0.5 + 2.5 * across * flank, -aside_m, aside_m)
        supporter = Point(clamp(ball.x_m - 2.0 * along, -2.0 * along, 6.0 * along), y_m)
    far_m, near_m = math.dist(goal, ball), field.penalty_area_depth_m + _STOPPER_M
    if far_m > near_m:
        stopper = between(goal, ball, clamp(0.5 * far_m, near_m, max(near_m, 8.0 * along)) / far_m)
    else:
        stopper = Point(-back_m, ball.y_m * 0.5)
    aside_m = 4.5 * across
    y_m = clamp(stopper.y_m + flank * (2.5 * across), -aside_m, aside_m)
    sweeper = Point(clamp(ball.x_m - 4.0 * along, -back_m, 1.0 * along), y_m)
    if ours and ball.x_m > -5.0 * along:
        aside_m = shooter_aside_m if ball.x_m > 3.0 * along else 5.0 * across
        y_m = clamp(ball.y_m - flank * (3.5 * across), -aside_m, aside_m)
        sweeper = Point(min(ball.x_m + 1.0 * along, shooter_m), y_m)
        if math.dist(sweeper, supporter) < _APART_M:  # the ball is in the corner: both would wait for the same pass
            sweeper = Point(sweeper.x_m, supporter.y_m - flank * _APART_M)
    aside_m = 6.0 * across
    y_m = clamp(ball.y_m - flank * (2.0 * across), -aside_m, aside_m)
    spare = Point(clamp(ball.x_m - 3.0 * along, -back_m, 2.0 * along), y_m)
    return [supporter, stopper, sweeper, spare]


def further_places(count: int, others: Sequence[Point], ball: Point, flank: float, field: Field) -> list[Point]:
    """Returns places of the robots of a large team for which `places` has none left, apart from those of the others.

    They are in rows behind the ball, on both flanks in turn.
    """
    along, across = scale(field)
    back_m, widest_m = before_area_m(field, _BACK_M), field.half_width_m - _TOUCH_LINE_M
    taken, found = [*others, ball], []
    for row in range(count):
        flank = -flank
        x_m = clamp(ball.x_m - (_ROW_BACK_M + _ROW_M * row) * along, -back_m, back_m)
        y_m = 0.5 * ball.y_m + flank * _ROW_Y_M * across
        shifts_m = (_SHIFT_M * sign * step for step in range(2 * count + 8) for sign in (flank, -flank))
        tried = [Point(x_m, clamp(y_m + shift_m, -widest_m, widest_m)) for shift_m in shifts_m]
        place = next((each for each in tried if all(math.dist(each, one) >= _APART_M for one in taken)), tried[0])
        taken.append(place)
        found.append(place)
    return found


def spread(places: Sequence[Point], field: Field, bodies: Bodies) -> list[Point]:
    """Returns the places of play; robots that would touch at them, as on a small field, stand side by side."""
    apart_m, found = 2 * bodies.robot_radius_m + _BESIDE_M, list[Point]()

    def is_free(place: Point) -> bool:
        return all(math.dist(place, other) >= apart_m for other in found)

    for place in places:
        asides_m = (sign * 0.5 * apart_m * step for step in range(1, 4 * len(places)) for sign in (1.0, -1.0))
        beside = (Point(place.x_m, place.y_m + aside_m) for aside_m in asides_m)
        possible = (each for each in beside if _is_inside(each, field, bodies) and not _in_area(each, field))
        found.append(place if is_free(place) else next(filter(is_free, possible), place))
    return found


def scale(field: Field) -> tuple[float, float]:
    """Returns how many times as long and as wide as the usual field a field is."""
    return field.length_m / _LENGTH_M, field.width_m / _WIDTH_M


def before_area_m(field: Field, distance_m: float) -> float:
    """Returns how far from the halfway line a place before a penalty area is."""
    return field.half_length_m - (field.penalty_area_depth_m + distance_m)


def beside_shot(own: Point, place: Point, ball: Point, field: Field) -> Point:
    """Returns the place, or one on the robot's own side of the way from the ball to the opponents' goal.

    A robot that stands in that way, or would cross it, takes the shot from the mate with the ball.
    """
    goal = field.goal_centre(1.0)
    way_rad, way_m = bearing_rad(ball, goal), math.dist(ball, goal)
    cos, sin = math.cos(way_rad), math.sin(way_rad)

    def seen(point: Point) -> tuple[float, float]:
        """Returns distances along the way and to its left."""
        x_m, y_m = point.x_m - ball.x_m, point.y_m - ball.y_m
        return x_m * cos + y_m * sin, y_m * cos - x_m * sin

    own_along_m, own_left_m = seen(own)
    along_m, left_m = seen(place)
    side = math.copysign(1.0, own_left_m)
    ahead_of_ball = max(own_along_m, along_m) > 0.0 and min(own_along_m, along_m) < way_m
    if way_m > _SHOT_M or not ahead_of_ball or left_m * side >= _BESIDE_SHOT_M:
        return place
    along_m = clamp(along_m, 0.0, way_m)
    left_m = side * _BESIDE_SHOT_M
    return Point(ball.x_m + along_m * cos - left_m * sin, ball.y_m + along_m * sin + left_m * cos)


def taker_place(spot: Point, way_rad: float) -> Point:
    """Returns the waiting place of a set piece's taker: behind the ball, opposite to the direction of play."""
    return ahead(spot, way_rad, -_TAKER_M)


def layoff_place(game: Game, field: Field) -> Point:
    """Returns the place of the receiver of the own set piece: behind the ball, where a robot that looks at the ball
    nearly looks at the opponents' goal, and so can play on without a turn; beside the taker, to see past it.
    """
    back_rad = bearing_rad(game.spot, field.goal_centre(1.0)) + math.pi
    nearer, further = [], []  # to the middle than that on the other side
    for turn_rad in _LAYOFF_RAD:
        both = [ahead(game.spot, back_rad + sign * turn_rad, _LAYOFF_M) for sign in (1.0, -1.0)]
        both.sort(key=lambda place: (abs(place.y_m), place.y_m))
        nearer.append(both[0])
        further.append(both[1])
    return next((place for place in (*nearer, *further) if field.in_field(*place, -0.3)), nearer[-1])


def first_opponent_place(game: Game, field: Field, bodies: Bodies = USUAL) -> Point:
    """Returns the place of the nearest robot at the other team's set piece: between the ball and the own goal.

    Where the goal is nearer to the ball than the rules let a robot come, it is beside that way.
    """
    place = ahead(game.spot, bearing_rad(game.spot, field.goal_centre(-1.0)), _keep_off_m(game))
    return allowed(place, game, field, bodies)


def helper_place(place: Point, game: Game, field: Field, bodies: Bodies = USUAL) -> Point:
    """Returns the place of a robot that is not the nearest of its team: one near `place` that the rules allow."""
    return helper_places([place], game, field, bodies)[0]


def helper_places(wanted: Sequence[Point], game: Game, field: Field, bodies: Bodies = USUAL) -> list[Point]:
    """Returns the places of robots that are not the nearest of their team: near the `wanted` ones, as the rules allow.

    They are apart from each other, and from the place of the nearest robot.
    """
    found, first = list[Point](), [] if game.whose is Whose.OURS else [first_opponent_place(game, field, bodies)]
    for each in wanted:
        place, taken = allowed(each, game, field, bodies), [*found, *first]
        found.append(place if _is_apart(place, taken, bodies) else _around(place, game, field, bodies, taken))
    return found


def allowed(place: Point, game: Game, field: Field, bodies: Bodies = USUAL) -> Point:
    """Returns the place, or one near it that the rules of the set piece allow."""
    if game.free_play:
        return place
    distance_m = _keep_off_m(game)
    if math.dist(place, game.spot) < distance_m:
        way_rad = bearing_rad(game.spot, place)
        if not field.in_field(*ahead(game.spot, way_rad, distance_m)):
            way_rad = bearing_rad(game.spot, Point(-0.3 * field.half_length_m, 0.0))
        place = ahead(game.spot, way_rad, distance_m)
    if _in_area(place, field) or not _is_inside(place, field, bodies):
        place = _around(place, game, field, bodies)
    if game.state is State.KICK_OFF and place.x_m > -_HALFWAY_M:
        aside_m = math.sqrt(max(0.0, distance_m**2 - _HALFWAY_M**2))
        y_m = math.copysign(max(abs(place.y_m), aside_m), place.y_m)
        place = Point(-_HALFWAY_M, y_m)
    return place


def circle(game: Game) -> Disc | None:
    """Returns the circle around the ball of a set piece that robots other than the taker keep out of; None in play."""
    if game.free_play or not game.state.is_set_piece:
        return None
    return Disc(game.spot, _keep_off_m(game) - _TOO_NEAR_M)


def next_step(
    own: Point, place: Point, game: Game, field: Field, others: Sequence[Robot] = (), bodies: Bodies = USUAL
) -> Point:
    """Returns the place, or a place on a way there that keeps the distance to the ball of a set piece.

    A robot that is too near to the ball goes to the nearest place at the distance that the arena, the areas and the
    other robots leave free. The way of another robot leads around the robots that stand, because they may close the
    shorter side of the ball; at a kick-off that of a robot in the wrong half leads around all robots.
    """
    if game.free_play:
        return place
    distance_m = _keep_off_m(game)
    if math.dist(own, game.spot) < distance_m - _TOO_NEAR_M:
        return _way_out(own, game, field, distance_m, [other.place for other in others], bodies)
    goes_home = game.state is State.KICK_OFF and own.x_m > 0.0
    passed = [other.place for other in others if goes_home or math.hypot(*other.velocity_m_s) < _STANDS_M_S]
    robots = [Disc(other, 2 * bodies.robot_radius_m + _PASSED_M) for other in passed]
    return _way_around(own, place, Disc(game.spot, distance_m - _PASSES_M), field, robots)


def _way_around(own: Point, place: Point, circle: Disc, field: Field, robots: Sequence[Disc]) -> Point:
    """Returns the next place on the shortest way in the field around the circle and the robots at it.

    The freest tangent of the circle does not do: where a wall or a robot closes it, the detour leads into the circle,
    and out.
    """

    def possible(turn: Point) -> bool:
        return field.in_field(*turn, _BESIDE_FIELD_M)

    turn = first_turn(own, place, [circle, *robots], possible) or first_turn(own, place, [circle], possible) or place
    return turn if turn == place else ahead(own, bearing_rad(own, turn), _STEP_M)


def _way_out(own: Point, game: Game, field: Field, distance_m: float, taken: Sequence[Point], bodies: Bodies) -> Point:
    straight_rad, bodies_m = bearing_rad(game.spot, own), 2 * bodies.robot_radius_m + _BESIDE_M
    for turn_rad in (0.0, *_TURNS_RAD):
        place = ahead(game.spot, straight_rad + turn_rad, distance_m)
        inside = field.in_field(*place, _BESIDE_FIELD_M)
        if inside and not _in_area(place, field) and all(math.dist(place, other) > bodies_m for other in taken):
            return place
    return ahead(game.spot, straight_rad, distance_m)


def _in_area(place: Point, field: Field) -> bool:
    return field.in_penalty_area(abs(place.x_m), place.y_m, 1.0, _AREA_M)


def _around(place: Point, game: Game, field: Field, bodies: Bodies, taken: Sequence[Point] = ()) -> Point:
    """Returns the nearest place that is in the field, at a kick-off in the own half, outside the areas, and apart from
    `taken`.

    Its distance from the ball is the same, or larger by as little as possible.
    """
    distance_m, way_rad = math.dist(game.spot, place), bearing_rad(game.spot, place)
    for further in range(math.ceil((field.length_m + field.width_m) / _FURTHER_M)):
        for turn_rad in (0.0, *_TURNS_RAD):
            other = ahead(game.spot, way_rad + turn_rad, distance_m + further * _FURTHER_M)
            own_half = game.state is not State.KICK_OFF or other.x_m <= -_HALFWAY_M
            free = own_half and _is_inside(other, field, bodies) and not _in_area(other, field)
            if free and _is_apart(other, taken, bodies):
                return other
    return place


def _is_inside(place: Point, field: Field, bodies: Bodies) -> bool:
    """Returns whether a place is in the field, and the body of a robot there is off the wall."""
    return field.in_field(*place, min(0.0, field.border_m - bodies.robot_radius_m - _OFF_WALL_M))


def _is_apart(place: Point, taken: Sequence[Point], bodies: Bodies) -> bool:
    apart_m = max(_APART_M, 2 * bodies.robot_radius_m + _BESIDE_M)
    return all(math.dist(place, other) >= apart_m for other in taken)


def _keep_off_m(game: Game) -> float:
    if game.state is State.DROP_BALL:
        return _DROPPED_BALL_M
    return _OWN_SET_PIECE_M if game.whose is Whose.OURS else _THEIR_SET_PIECE_M

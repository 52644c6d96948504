"""Book of the own set pieces: where the receiver waits, in at least two variants for each; attack frame.

The taker draws a variant, so that matches do not open alike, and passes over one whose way is blocked. It announces the
receiver's place with the pass; until the receiver has heard of it, it waits at the place of the variant that the number
of the set piece gives.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from procs.behaviour import aim, formation
from procs.behaviour.bodies import USUAL, Bodies
from procs.behaviour.game import Game
from procs.behaviour.view import Robot
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.geometry import clamp

_CENTRE = Point(0.0, 0.0)
_CUT_BACK_M = 1.35  # before the opponents' penalty area
_INSIDE_M = 0.8  # receivers wait so far inside the touch lines
_FREE_M = 1.5  # and so far from rivals


class Variant(NamedTuple):
    """One way to take a set piece; its distances grow and shrink with the field, as those of formations do."""

    name: str
    place: Callable[[Game, Field], Point]
    """Place of the receiver, which `formation.helper_place` brings within the rules."""


def lay_off(game: Game, field: Field) -> Point:
    """Back and beside the way to the goal, so that the receiver can shoot or pass without a turn."""
    return formation.layoff_place(game, field)


def square(game: Game, field: Field) -> Point:
    """Level with the ball, on the side of the middle."""
    return _inside(_from(game.spot, 0.0, -_away(game) * 3.2, field), field)


def ahead_on_the_wing(game: Game, field: Field) -> Point:
    """Ahead along the touch line."""
    return _inside(_from(game.spot, 3.5, 0.0, field), field)


def long_to_the_wing(game: Game, field: Field) -> Point:
    """Far ahead, on the other side of the field."""
    return _inside(_from(Point(game.spot.x_m, 0.0), 5.5, -_away(game) * 3.0, field), field)


def back_left(_game: Game, field: Field) -> Point:
    """Behind the centre mark, a little to the left."""
    return _from(_CENTRE, -2.2, 1.0, field)


def back_right(_game: Game, field: Field) -> Point:
    """Behind the centre mark, a little to the right."""
    return _from(_CENTRE, -2.2, -1.0, field)


def wide_left(_game: Game, field: Field) -> Point:
    """Beside the centre mark, on the left wing of the own half."""
    return _from(_CENTRE, -0.7, 4.5, field)


def wide_right(_game: Game, field: Field) -> Point:
    """Beside the centre mark, on the right wing of the own half."""
    return _from(_CENTRE, -0.7, -4.5, field)


def cut_back(game: Game, field: Field) -> Point:
    """Before the penalty area, on the corner's side of the goal."""
    return _from(Point(formation.before_area_m(field, _CUT_BACK_M), 0.0), 0.0, _away(game) * 2.2, field)


def short(game: Game, field: Field) -> Point:
    """Near the corner, back along the touch line."""
    return _inside(_from(game.spot, -3.0, 0.0, field), field)


BOOK: Mapping[State, Sequence[Variant]] = {
    state: tuple(Variant(place.__name__.replace("_", " "), place) for place in places)
    for state, places in {
        State.KICK_OFF: (back_left, wide_right, back_right, wide_left),
        State.FREE_KICK: (lay_off, square),
        State.THROW_IN: (lay_off, ahead_on_the_wing),
        State.GOAL_KICK: (lay_off, long_to_the_wing),
        State.CORNER_KICK: (cut_back, short),
    }.items()
}
"""Variants of each set piece but the penalty, which is shot."""


def choose(
    game: Game, rivals: Sequence[Robot], field: Field, bodies: Bodies, turn: int | None = None
) -> tuple[str, Point] | None:
    """Returns the variant of the own set piece and the receiver's place; None for a set piece without a receiver.

    It is the first whose way is free, beginning with that of the `turn`, or of the set piece's number; if all are
    blocked, the one with the most room.
    """
    variants = BOOK.get(game.state)
    if not variants:
        return None
    turn = (game.number if turn is None else turn) % len(variants)
    found = [(each.name, receiver_place(each, game, field, bodies)) for each in (*variants[turn:], *variants[:turn])]
    return max(found, key=lambda each: min(aim.LANE_RAD, room_rad(game.spot, each[1], rivals, bodies)))


def receiver_place(variant: Variant, game: Game, field: Field, bodies: Bodies = USUAL) -> Point:
    """Returns the receiver's place within the rules."""
    return formation.helper_place(variant.place(game, field), game, field, bodies=bodies)


def room_rad(spot: Point, place: Point, rivals: Sequence[Robot], bodies: Bodies) -> float:
    """Returns the free angle beside the way of a pass to the receiver's place; negative if a rival blocks the way, or
    stands so near to the place that it gets the ball as soon as the receiver.
    """
    crowded = any(math.dist(place, rival.place) < _FREE_M for rival in rivals)
    return -math.pi if crowded else aim.lane_rad(spot, place, rivals, bodies)


def _from(place: Point, ahead_m: float, left_m: float, field: Field) -> Point:
    """Returns the place that lies so far ahead and to the left of another on the usual field, scaled to this one."""
    along, across = formation.scale(field)
    return Point(place.x_m + ahead_m * along, place.y_m + left_m * across)


def _away(game: Game) -> float:
    return math.copysign(1.0, game.spot.y_m)


def _inside(place: Point, field: Field) -> Point:
    x_m, y_m = field.half_length_m - _INSIDE_M, field.half_width_m - _INSIDE_M
    return Point(clamp(place.x_m, -x_m, x_m), clamp(place.y_m, -y_m, y_m))

"""Places of the team's robots without the ball: the formation in play, and what the book says at set pieces."""

import math

from procs.behaviour import formation, set_pieces
from procs.behaviour.game import Game, Whose
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point
from procs.model.game_states import State

PLAY = Game(State.PLAY, stopped=False)

_MIDDLE_M = 1.5
"""A ball no further from the middle leaves the supporter on its flank."""


def posts(
    count: int, view: View, field: Field, game: Game, sooner: bool, supporter: Robot | None = None
) -> list[Point]:
    """Returns the places of the supporter and of the others, the most important first: at least `count`.

    `sooner`: the team is sooner at the ball; the supporter then offers itself ahead of it. At a set piece nothing that
    robots do on their ways changes the places: neither who is sooner, nor where the ball is carried to its spot, nor on
    which side the supporter drives. A dropped ball counts as the other team's.
    """
    if game.free_play:
        found = _formation(count, view.ball.place, sooner, _flank(view.ball.place, supporter), field)
        return formation.spread(found, field, view.bodies)
    received = _receiver_place(view, field, game, supporter)
    found = _formation(count, game.spot, game.whose is Whose.OURS, _set_piece_flank(game, received), field)
    if received:
        found[0] = received
    return formation.helper_places(found, game, field, view.bodies)


def _formation(count: int, ball: Point, ours: bool, flank: float, field: Field) -> list[Point]:
    found = formation.places(ball, ours, flank, field)
    return found + formation.further_places(count - len(found), found, ball, flank, field)


def _flank(ball: Point, supporter: Robot | None) -> float:
    """Returns the supporter's side of the field, -1 or 1: away from the ball; near the middle, the side where it is."""
    aside_m = supporter.place.y_m if supporter and abs(ball.y_m) < _MIDDLE_M else -ball.y_m
    return math.copysign(1.0, aside_m)


def _set_piece_flank(game: Game, received: Point | None) -> float:
    """Returns the same; near the middle, the side of the receiver, or both sides in turn."""
    if abs(game.spot.y_m) >= _MIDDLE_M:
        return math.copysign(1.0, -game.spot.y_m)
    if received and received.y_m != game.spot.y_m:
        return math.copysign(1.0, received.y_m - game.spot.y_m)
    return 1.0 if game.number % 2 else -1.0


def _receiver_place(view: View, field: Field, game: Game, supporter: Robot | None) -> Point | None:
    """Returns where the supporter receives the own set piece: as the taker has told, or next in turn."""
    if game.whose is not Whose.OURS:
        return None
    if supporter:
        for robot in sorted((view.own, *view.mates), key=lambda robot: robot.name):
            if robot.agreement.receiver == supporter.name:
                return robot.agreement.place
    planned = set_pieces.choose(game, (), field, view.bodies)
    return planned[1] if planned else None

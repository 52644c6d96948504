"""Restarts after an interruption: the set piece, its team, and the place of the ball."""

import math
from typing import NamedTuple

from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.geometry import clamp
from procs.model.teams import Ends, Team


class Restart(NamedTuple):
    """One set piece."""

    state: State
    team: Team
    spot: Point


_CORNER_INSET_M = 0.2  # of a corner kick's ball from both lines
_LINE_INSET_M = 0.1  # of a throw-in's ball from the touch line
_FREE_KICK_INSET_M = 0.5  # of a free kick's ball from the touch lines, at least


def kick_off(team: Team) -> Restart:
    """Returns the kick-off of a team, from the centre mark."""
    return Restart(State.KICK_OFF, team, Point(0.0, 0.0))


def dropped_ball(place: Point, field: Field) -> Restart:
    """Returns a dropped ball at the restart spot nearest to the place."""
    spot = min(field.restart_spots(), key=lambda mark: (math.dist(mark, place), mark))
    return Restart(State.DROP_BALL, Team.NONE, spot)


def ball_left_there(place: Point, field: Field) -> Restart:
    """Returns a dropped ball where play was stopped, as near to goals and lines as a free kick may be."""
    return Restart(State.DROP_BALL, Team.NONE, _for_free_kick(place, field))


def after_side_line(place: Point, touched_by: Team, field: Field) -> Restart:
    """Returns the throw-in of the other team where the ball went out; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, field)
    x_m = _within(place.x_m, field.half_length_m - field.corner_radius_m)
    y_m = math.copysign(field.half_width_m - _LINE_INSET_M, place.y_m)
    return Restart(State.THROW_IN, touched_by.other, Point(x_m, y_m))


def after_goal_line(place: Point, touched_by: Team, field: Field, ends: Ends) -> Restart:
    """Returns a corner or goal kick; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, field)
    side = math.copysign(1.0, place.x_m)
    if ends.side_of(touched_by) == side:
        return corner_kick(touched_by.other, place, field)
    return goal_kick(touched_by.other, place.y_m, field, ends)


def corner_kick(team: Team, place: Point, field: Field) -> Restart:
    """Returns the corner kick of a team, from the corner nearest to the place."""
    x_m, y_m = field.half_length_m - _CORNER_INSET_M, field.half_width_m - _CORNER_INSET_M
    return Restart(State.CORNER_KICK, team, Point(math.copysign(x_m, place.x_m), math.copysign(y_m, place.y_m)))


def goal_kick(team: Team, y_m: float, field: Field, ends: Ends) -> Restart:
    """Returns the goal kick of a team, from the restart mark before its goal where the ball went out."""
    x_m = ends.side_of(team) * (field.half_length_m - field.penalty_mark_distance_m)
    return Restart(State.GOAL_KICK, team, Point(x_m, math.copysign(field.restart_offset_m, y_m)))


def after_foul(place: Point, offender: Team, field: Field) -> Restart:
    """Returns the free kick of the other team at the place, at most as near to a goal as the penalty marks."""
    return Restart(State.FREE_KICK, offender.other, _for_free_kick(place, field))


def penalty(team: Team, field: Field, ends: Ends) -> Restart:
    """Returns the penalty of a team, from the mark before the other team's goal."""
    return Restart(State.PENALTY, team, field.penalty_mark(ends.side_of(team.other)))


def _for_free_kick(place: Point, field: Field) -> Point:
    x_m = _within(place.x_m, field.half_length_m - field.penalty_mark_distance_m)
    return Point(x_m, _within(place.y_m, field.half_width_m - _FREE_KICK_INSET_M))


def _within(value_m: float, limit_m: float) -> float:
    return clamp(value_m, -limit_m, limit_m)

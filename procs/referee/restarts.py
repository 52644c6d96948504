"""Restarts after an interruption: the set piece, its team, and the place of the ball."""

import math
from typing import NamedTuple

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.geometry import clamp
from procs.model.teams import Ends, Team
from procs.referee.rules import Rules


class Restart(NamedTuple):
    """One set piece."""

    state: State
    team: Team
    spot: Point


def kick_off(team: Team) -> Restart:
    """Returns the kick-off of a team, from the centre mark."""
    return Restart(State.KICK_OFF, team, Point(0.0, 0.0))


def dropped_ball(place: Point, rules: Rules) -> Restart:
    """Returns a dropped ball at the restart spot nearest to the place."""
    spot = min(rules.field.restart_spots(), key=lambda mark: (math.dist(mark, place), mark))
    return Restart(State.DROP_BALL, Team.NONE, spot)


def ball_left_there(place: Point, rules: Rules) -> Restart:
    """Returns a dropped ball where play was stopped, as near to goals and lines as a free kick may be."""
    return Restart(State.DROP_BALL, Team.NONE, _for_free_kick(place, rules))


def after_side_line(place: Point, touched_by: Team, rules: Rules) -> Restart:
    """Returns the throw-in of the other team where the ball went out; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, rules)
    field = rules.field
    x_m = _within(place.x_m, field.half_length_m - field.corner_radius_m)
    y_m = math.copysign(field.half_width_m - rules.throw_in_inset_m, place.y_m)
    return Restart(State.THROW_IN, touched_by.other, Point(x_m, y_m))


def after_goal_line(place: Point, touched_by: Team, rules: Rules, ends: Ends) -> Restart:
    """Returns a corner or goal kick; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, rules)
    side = math.copysign(1.0, place.x_m)
    if ends.side_of(touched_by) == side:
        return corner_kick(touched_by.other, place, rules)
    return goal_kick(touched_by.other, place.y_m, rules, ends)


def corner_kick(team: Team, place: Point, rules: Rules) -> Restart:
    """Returns the corner kick of a team, from the corner nearest to the place."""
    field, inset_m = rules.field, rules.corner_inset_m
    x_m, y_m = field.half_length_m - inset_m, field.half_width_m - inset_m
    return Restart(State.CORNER_KICK, team, Point(math.copysign(x_m, place.x_m), math.copysign(y_m, place.y_m)))


def goal_kick(team: Team, y_m: float, rules: Rules, ends: Ends) -> Restart:
    """Returns the goal kick of a team, from the restart mark before its goal where the ball went out."""
    field = rules.field
    x_m = ends.side_of(team) * (field.half_length_m - field.penalty_mark_distance_m)
    return Restart(State.GOAL_KICK, team, Point(x_m, math.copysign(field.restart_offset_m, y_m)))


def after_foul(place: Point, offender: Team, rules: Rules) -> Restart:
    """Returns the free kick of the other team at the place, at most as near to a goal as the penalty marks."""
    return Restart(State.FREE_KICK, offender.other, _for_free_kick(place, rules))


def penalty(team: Team, rules: Rules, ends: Ends) -> Restart:
    """Returns the penalty of a team, from the mark before the other team's goal."""
    return Restart(State.PENALTY, team, rules.field.penalty_mark(ends.side_of(team.other)))


def _for_free_kick(place: Point, rules: Rules) -> Point:
    field = rules.field
    x_m = _within(place.x_m, field.half_length_m - field.penalty_mark_distance_m)
    return Point(x_m, _within(place.y_m, field.half_width_m - rules.free_kick_inset_m))


def _within(value_m: float, limit_m: float) -> float:
    return clamp(value_m, -limit_m, limit_m)

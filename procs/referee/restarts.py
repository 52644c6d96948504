"""Restarts after an interruption: the set piece, its team, and the place of the ball."""

import math
from enum import IntEnum
from typing import NamedTuple

from procs.model.field import SIDES, Field, Point
from procs.model.robot import MAGENTA, team_of


class State(IntEnum):
    """States of the game; the numbers are those of the message."""

    FROZEN = 0
    PLAY = 1
    KICK_OFF = 2
    DROP_BALL = 3
    PENALTY = 4
    CORNER_KICK = 5
    THROW_IN = 6
    FREE_KICK = 7
    GOAL_KICK = 8
    HALF_TIME = 9


class Team(IntEnum):
    """Teams; the numbers are those of the message."""

    NONE = 0
    CYAN = 1
    MAGENTA = 2

    @property
    def other(self) -> "Team":
        """The other team; NONE for NONE."""
        return Team(3 - self) if self else self

    @property
    def side(self) -> float:
        """Side of the goal that the team defends; 0 for NONE."""
        return (0.0, SIDES[0], SIDES[1])[self]


class Restart(NamedTuple):
    """One set piece."""

    state: State
    team: Team
    spot: Point


_CORNER_INSET_M = 0.2
_LINE_INSET_M = 0.1


def team_number(robot: str) -> Team:
    """Returns the team of a robot; NONE for the empty name."""
    if not robot:
        return Team.NONE
    return Team.MAGENTA if team_of(robot) == MAGENTA else Team.CYAN


def kick_off(team: Team) -> Restart:
    """Returns the kick-off of a team, from the centre mark."""
    return Restart(State.KICK_OFF, team, Point(0.0, 0.0))


def dropped_ball(place: Point, field: Field) -> Restart:
    """Returns a dropped ball at the restart spot nearest to the place."""
    spot = min(field.restart_spots(), key=lambda mark: (math.dist(mark, place), mark))
    return Restart(State.DROP_BALL, Team.NONE, spot)


def after_side_line(place: Point, touched_by: Team, field: Field) -> Restart:
    """Returns the throw-in of the other team where the ball went out; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, field)
    x_m = _within(place.x_m, field.half_length_m - field.corner_radius_m)
    y_m = math.copysign(field.half_width_m - _LINE_INSET_M, place.y_m)
    return Restart(State.THROW_IN, touched_by.other, Point(x_m, y_m))


def after_goal_line(place: Point, touched_by: Team, field: Field) -> Restart:
    """Returns a corner or goal kick; a dropped ball without a last touch."""
    if touched_by is Team.NONE:
        return dropped_ball(place, field)
    side = math.copysign(1.0, place.x_m)
    if touched_by.side == side:
        corner = Point(side * field.half_length_m, math.copysign(field.half_width_m, place.y_m))
        inset = Point(
            corner.x_m - math.copysign(_CORNER_INSET_M, corner.x_m),
            corner.y_m - math.copysign(_CORNER_INSET_M, corner.y_m),
        )
        return Restart(State.CORNER_KICK, touched_by.other, inset)
    return goal_kick(touched_by.other, place.y_m, field)


def goal_kick(team: Team, y_m: float, field: Field) -> Restart:
    """Returns the goal kick of a team, from the restart mark before its goal where the ball went out."""
    x_m = team.side * (field.half_length_m - field.penalty_mark_distance_m)
    return Restart(State.GOAL_KICK, team, Point(x_m, math.copysign(field.restart_offset_m, y_m)))


def after_foul(place: Point, offender: Team, field: Field) -> Restart:
    """Returns the free kick of the other team at the place, at most as near to a goal as the penalty marks."""
    x_m = _within(place.x_m, field.half_length_m - field.penalty_mark_distance_m)
    return Restart(State.FREE_KICK, offender.other, Point(x_m, _within(place.y_m, field.half_width_m - 0.5)))


def _within(value_m: float, limit_m: float) -> float:
    return min(limit_m, max(-limit_m, value_m))

"""Places that robots keep at a set piece: their distance to the ball, the own half, the keeper's area (2016)."""

import math
from collections.abc import Mapping

from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee.restarts import Restart

OWN_M = 2.0
"""Least distance of the team that takes the set piece, except for the taker."""
THEIRS_M = 3.0
"""Least distance of the other team, except for one robot in its own penalty area."""
DROPPED_M = 1.0
"""Least distance of every robot at a dropped ball."""
TOLERANCE_M = 0.05
"""A robot that is nearer, or further in the wrong half, by less than this is not misplaced."""

_ENDS, _FIELD = Ends(), Field()


def misplaced(
    restart: Restart, robots: Mapping[str, Point], ends: Ends = _ENDS, field: Field = _FIELD, keeper: str = ""
) -> list[str]:
    """Returns the robots that stand where the rules do not allow it, by name.

    `robots` gives the middle of each; `keeper` is the goalkeeper that faces a penalty.
    """
    found = {*too_near(restart, robots, ends, field), *in_wrong_half(restart, robots, ends)}
    if restart.state is State.PENALTY and keeper in robots:
        side = ends.side_of(restart.team.other)
        found.discard(keeper)
        found.update([] if field.in_goal_area(*robots[keeper], side, TOLERANCE_M) else [keeper])
    return sorted(found)


def too_near(
    restart: Restart,
    robots: Mapping[str, Point],
    ends: Ends = _ENDS,
    field: Field = _FIELD,
    tolerance_m: float = TOLERANCE_M,
) -> list[str]:
    """Returns the robots that are nearer to the ball than the rules allow."""
    taker = taker_of(restart, robots)
    found = [
        name
        for name, middle in robots.items()
        if name != taker and math.dist(middle, restart.spot) < _least_m(restart, name) - tolerance_m
    ]
    defenders = [name for name in found if _defends_area(restart, name, robots[name], ends, field)]
    if defenders:
        found.remove(max(defenders, key=lambda name: (abs(robots[name].x_m), name)))
    return found


def in_wrong_half(
    restart: Restart, robots: Mapping[str, Point], ends: Ends = _ENDS, tolerance_m: float = TOLERANCE_M
) -> list[str]:
    """Returns the robots that are in the other team's half at a kick-off; none at other set pieces."""
    if restart.state is not State.KICK_OFF:
        return []
    taker = taker_of(restart, robots)
    return [
        name
        for name, middle in robots.items()
        if name != taker and middle.x_m * ends.side_of(team_number(name)) < -tolerance_m
    ]


def taker_of(restart: Restart, robots: Mapping[str, Point]) -> str:
    """Returns the robot of the team that is nearest to the ball; empty without one."""
    taking = [name for name in robots if restart.team is not Team.NONE and team_number(name) is restart.team]
    return min(taking, key=lambda name: (math.dist(robots[name], restart.spot), name), default="")


def _least_m(restart: Restart, robot: str) -> float:
    if restart.state is State.DROP_BALL:
        return DROPPED_M
    return OWN_M if team_number(robot) is restart.team else THEIRS_M


def _defends_area(restart: Restart, name: str, place: Point, ends: Ends, field: Field) -> bool:
    team = team_number(name)
    return restart.team.other is team and field.in_penalty_area(*place, ends.side_of(team))

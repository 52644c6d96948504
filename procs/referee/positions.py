"""Places that robots have to keep at a set piece: their distance to the ball, and the own half at a kick-off."""

import math
from collections.abc import Mapping

from procs.model.field import Point
from procs.model.robot import side_of, team_of
from procs.referee.restarts import Restart, State, Team, team_number

OWN_M = 2.0
"""Least distance of the team that takes the set piece, except for the taker."""
THEIRS_M = 3.0
"""Least distance of the other team."""
DROPPED_M = 1.0
"""Least distance of every robot at a dropped ball."""
_TOLERANCE_M = 0.05


def misplaced(restart: Restart, robots: Mapping[str, Point]) -> list[str]:
    """Returns the robots that stand where the rules do not allow it, by name; `robots` gives the middle of each."""
    return sorted({*too_near(restart, robots), *in_wrong_half(restart, robots)})


def too_near(restart: Restart, robots: Mapping[str, Point]) -> list[str]:
    """Returns the robots that are nearer to the ball than the rules allow."""
    taker = _taker(restart, robots)
    return [
        name
        for name, middle in robots.items()
        if name != taker and math.dist(middle, restart.spot) < _least_m(restart, name) - _TOLERANCE_M
    ]


def in_wrong_half(restart: Restart, robots: Mapping[str, Point]) -> list[str]:
    """Returns the robots that are in the other team's half at a kick-off; none at other set pieces."""
    if restart.state is not State.KICK_OFF:
        return []
    taker = _taker(restart, robots)
    return [
        name for name, middle in robots.items() if name != taker and middle.x_m * side_of(team_of(name)) < -_TOLERANCE_M
    ]


def _taker(restart: Restart, robots: Mapping[str, Point]) -> str:
    """Returns the robot of the team that is nearest to the ball; empty without one."""
    taking = [name for name in robots if restart.team is not Team.NONE and team_number(name) is restart.team]
    return min(taking, key=lambda name: (math.dist(robots[name], restart.spot), name), default="")


def _least_m(restart: Restart, robot: str) -> float:
    if restart.state is State.DROP_BALL:
        return DROPPED_M
    return OWN_M if team_number(robot) is restart.team else THEIRS_M

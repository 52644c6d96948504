"""Places that robots keep at a set piece: their distance to the ball, the own half, the keeper's area (2016)."""

import math
from collections.abc import Mapping

from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee.restarts import Restart
from procs.referee.rules import Rules

_ENDS, _RULES = Ends(), Rules()


def misplaced(
    restart: Restart, robots: Mapping[str, Point], ends: Ends = _ENDS, rules: Rules = _RULES, keeper: str = ""
) -> list[str]:
    """Returns the robots that stand where the rules do not allow it, by name.

    `robots` gives the middle of each; `keeper` is the goalkeeper that faces a penalty.
    """
    tolerance_m = rules.tolerance_m
    near = too_near(restart, robots, ends, rules, tolerance_m)
    found = {*near, *in_wrong_half(restart, robots, ends, tolerance_m)}
    if restart.state is State.PENALTY and keeper in robots:
        side = ends.side_of(restart.team.other)
        found.discard(keeper)
        found.update([] if rules.field.in_goal_area(*robots[keeper], side, tolerance_m) else [keeper])
    return sorted(found)


def too_near(restart: Restart, robots: Mapping[str, Point], ends: Ends, rules: Rules, tolerance_m: float) -> list[str]:
    """Returns the robots that are nearer to the ball than the rules allow, by more than the tolerance."""
    taker = taker_of(restart, robots)
    found = [
        name
        for name, middle in robots.items()
        if name != taker and math.dist(middle, restart.spot) < _least_m(restart, name, rules) - tolerance_m
    ]
    defenders = [name for name in found if _defends_area(restart, name, robots[name], ends, rules.field)]
    if defenders:
        found.remove(max(defenders, key=lambda name: (abs(robots[name].x_m), name)))
    return found


def in_wrong_half(restart: Restart, robots: Mapping[str, Point], ends: Ends, tolerance_m: float) -> list[str]:
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


def _least_m(restart: Restart, robot: str, rules: Rules) -> float:
    if restart.state is State.DROP_BALL:
        return rules.dropped_m
    return rules.own_m if team_number(robot) is restart.team else rules.theirs_m


def _defends_area(restart: Restart, name: str, place: Point, ends: Ends, field: Field) -> bool:
    team = team_number(name)
    return restart.team.other is team and field.in_penalty_area(*place, ends.side_of(team))

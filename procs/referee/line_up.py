"""Conditions for the start of a set piece: robots stand where the rules allow it, and no team waits for a robot."""

from procs.model.field import Field
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee.cards import Cards
from procs.referee.positions import misplaced
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from procs.referee.sight import Sight


def misplaced_robots(restart: Restart, sight: Sight, ends: Ends, rules: Rules) -> list[str]:
    """Returns the robots that are misplaced: distances are those to the ball, which may lie beside the spot."""
    keeper = sight.goalkeeper(restart.team.other)
    return misplaced(restart._replace(spot=sight.ball), sight.robots, ends, rules, keeper)


def keeper_is_away(restart: Restart, sight: Sight, field: Field) -> bool:
    """Returns whether the goalkeeper that faces a penalty is not between its posts yet.

    It is misplaced only outside its goal area, but the penalty waits for it.
    """
    keeper = sight.goalkeeper(restart.team.other)
    return restart.state is State.PENALTY and bool(keeper) and abs(sight.robots[keeper].y_m) > field.goal_width_m / 2


def incomplete_team(sight: Sight, cards: Cards, least_robots: int) -> Team:
    """Returns a team that has too few robots and may get more, or NONE; red cards leave none to wait for.

    A team without any robot is waited for if one of them comes back.
    """
    teams = (Team.CYAN, Team.MAGENTA)
    return next((team for team in teams if _waits(team, len(sight.team(team)), cards, least_robots)), Team.NONE)


def _waits(team: Team, robots: int, cards: Cards, least_robots: int) -> bool:
    away = [robot for robot in cards.sent_off if team_number(robot) is team]
    dismissed = len(cards.dismissed.intersection(away))
    comes_back = dismissed < len(away)
    if not robots:
        return comes_back
    return robots < least_robots and (robots + dismissed < least_robots or comes_back)

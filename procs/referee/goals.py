"""Goals: which count, and which restart follows (2016, laws 8, 10, 13 and 14)."""

import math
from typing import NamedTuple

from procs.model.events import Event
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart, after_goal_line, corner_kick, goal_kick, kick_off
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.touches import Touches


class Verdict(NamedTuple):
    """Judgement of a ball in a goal."""

    scorer: Team
    """Team that gets the goal; NONE: the goal does not count."""
    restart: Restart
    reason: Reason | None = None


def judge(event: Event, piece: State, touches: Touches, sight: Sight, ends: Ends, rules: Rules) -> Verdict:
    """Judges a ball in a goal, after the set piece with which this stretch of the game began.

    A ball that no robot has touched since, or since a person put it down, is no goal.
    """
    place = Point(event.x_m, event.y_m)
    conceding = ends.defender(place.x_m)
    if not (event.robot and touches.last):
        return Verdict(Team.NONE, after_goal_line(place, Team.NONE, rules, ends))
    scorer = conceding.other
    reason = _why_not(scorer, piece, touches, sight, ends)
    if reason and team_number(touches.last) is conceding:
        return Verdict(Team.NONE, corner_kick(scorer, place, rules), reason)
    if reason:
        return Verdict(Team.NONE, goal_kick(conceding, math.copysign(1.0, place.y_m), rules, ends), reason)
    return Verdict(scorer, kick_off(conceding))


def _why_not(scorer: Team, piece: State, touches: Touches, sight: Sight, ends: Ends) -> Reason | None:
    """Returns why the goal does not count for the team that attacks; None if it does."""
    team = team_number(touches.last)
    own_goal = team is not scorer
    direct = touches.robots == {touches.taker} and piece is not State.PLAY
    if own_goal and direct and len(sight.team(team)) > 1:
        return Reason.OWN_GOAL
    if not own_goal and touches.place.x_m * ends.side_of(team) > 0:
        return Reason.OWN_HALF
    if len(sight.team(scorer)) < 2:
        return None  # a robot that is alone has no mate to pass to
    reason = _why_not_after(piece, scorer, touches)
    if reason is None and not own_goal and touches.owes_pass is team:
        return Reason.NO_PASS
    return reason


def _why_not_after(piece: State, scorer: Team, touches: Touches) -> Reason | None:
    """Returns why a goal does not count after a set piece; None if it does.

    After a dropped ball two robots must have touched it. After others a mate of the taker must have, which a rival off
    which the ball goes in does not replace, after a free roll unless the time for the set piece was over. Rivals that
    have had the ball lift both conditions: one from which it bounced does not.
    """
    if piece is State.DROP_BALL:
        return Reason.NO_SECOND_ROBOT if len(touches.robots) < 2 else None
    of_set_piece = piece not in (State.PLAY, State.PENALTY) or scorer is touches.late
    if not of_set_piece or touches.intercepted or scorer is not team_number(touches.taker):
        return None
    if all(robot == touches.taker or team_number(robot) is not scorer for robot in touches.robots):
        return Reason.NO_SECOND_ROBOT
    return None if touches.passed or touches.overdue else Reason.NOT_FREE

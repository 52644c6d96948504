"""Goals: which count, and which restart follows (2016, laws 8, 10, 13 and 14)."""

import math
from typing import NamedTuple

from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart, after_goal_line, corner_kick, goal_kick, kick_off
from procs.referee.sight import Sight
from procs.referee.touches import Touches


class Verdict(NamedTuple):
    """Judgement of a ball in a goal."""

    scorer: Team
    """Team that gets the goal; NONE: the goal does not count."""
    restart: Restart
    reason: Reason | None = None


def judge(place: Point, piece: State, touches: Touches, sight: Sight, ends: Ends, field: Field) -> Verdict:
    """Judges a ball in the goal at `place`, after the set piece with which this stretch of the game began."""
    conceding = ends.defender(place.x_m)
    if touches.disturbed:
        return Verdict(Team.NONE, after_goal_line(place, Team.NONE, field, ends))
    team = team_number(touches.last)
    if team is conceding:
        direct = touches.robots == {touches.taker} and len(sight.team(team)) > 1
        if direct and piece is not State.PLAY:
            return Verdict(Team.NONE, corner_kick(conceding.other, place, field), Reason.OWN_GOAL)
        return Verdict(conceding.other, kick_off(conceding))
    reason = _why_not(piece, touches, sight, ends)
    if reason:
        return Verdict(Team.NONE, goal_kick(conceding, math.copysign(1.0, place.y_m), field, ends), reason)
    return Verdict(conceding.other, kick_off(conceding))


def _why_not(piece: State, touches: Touches, sight: Sight, ends: Ends) -> Reason | None:
    """Returns why the goal of the team that attacks does not count; None if it does."""
    team = team_number(touches.last)
    if touches.place.x_m * ends.side_of(team) > 0:
        return Reason.OWN_HALF
    if len(sight.team(team)) < 2:
        return None  # a robot that is alone has no mate to pass to
    if _lacks_second_robot(team, piece, touches):
        return Reason.NO_SECOND_ROBOT
    if touches.owes_pass is team:
        return Reason.NO_PASS
    return None


def _lacks_second_robot(team: Team, piece: State, touches: Touches) -> bool:
    """Returns whether a set piece went into the goal without a second robot.

    After a dropped ball any will do; after others it is a mate of the taker, unless rivals have had the ball: one from
    which it bounced does not count.
    """
    if piece is State.DROP_BALL:
        return len(touches.robots) < 2
    of_set_piece = piece not in (State.PLAY, State.PENALTY) or team is touches.late
    if not of_set_piece or touches.intercepted or team is not team_number(touches.taker):
        return False
    return all(robot == touches.taker or team_number(robot) is not team for robot in touches.robots)

"""Robots that play on without a radio: whether mates are about, and the job of a robot that hears none of them."""

import math
from collections.abc import Mapping

from procs.behaviour import ballistics
from procs.behaviour.game import Game
from procs.behaviour.posts import PLAY, posts
from procs.behaviour.roles import (
    ATTACKER,
    DEFENDER,
    GOALKEEPER,
    PASSER,
    SUPPORTER,
    Job,
    opponents_time_s,
    time_to_ball_s,
)
from procs.behaviour.view import View
from procs.model.field import Field
from procs.model.robot import ABSENT, Player, number_of_player, team_of_player

_REMEMBERED_S = 10.0  # longer than a stoppage, in which mates stand
_PLAYS_M_S = 0.3  # a robot that was never faster may be out of order
_STAY_S = 0.3  # an attacker keeps its role unless a mate is so much faster at the ball


class Company:
    """Tells a robot without mates on the radio whether it is alone; call `watch` once a tick."""

    def __init__(self) -> None:
        self._unseen_s = math.inf

    def watch(self, view: View, duration_s: float) -> bool:
        """Returns whether the robot hears no mate that plays, but has heard one or seen one drive lately."""
        hears = any(mate.role != ABSENT for mate in view.mates)
        sees = any(math.hypot(*mate.velocity_m_s) > _PLAYS_M_S for mate in view.silent_mates)
        self._unseen_s = 0.0 if hears or sees else self._unseen_s + duration_s
        return not hears and self._unseen_s < _REMEMBERED_S


def rank_of(robot: str, players: Mapping[str, Player]) -> int:
    """Returns how many players of the robot's team have a lower number."""
    team, number = team_of_player(robot, players), number_of_player(robot, players)
    return sum(player.team == team and player.number < number for player in players.values())


def job_among_silent(view: View, rank: int, field: Field, game: Game = PLAY) -> Job:
    """Returns the job of a robot that hears no mate.

    The lowest number of the players keeps the goal. Another attacks if it meets the ball before the mates that it
    sees; a mate in the own penalty area counts as the goalkeeper. Otherwise its place is that of its number.
    """
    if rank == 0:
        return Job(GOALKEEPER, field.goal_centre(-1.0))
    course = ballistics.Course(view.ball, view.bodies)
    mates = [mate for mate in view.silent_mates if not field.in_penalty_area(*mate.place, -1.0)]
    mates_s = min((time_to_ball_s(mate, view.ball, course) for mate in mates), default=math.inf)
    own_s = time_to_ball_s(view.own, view.ball, course) - _STAY_S * (view.own.role == ATTACKER)
    if own_s <= mates_s and view.own.role != PASSER:
        return Job(ATTACKER, view.ball.place)
    found = posts(rank, view, field, game, mates_s <= opponents_time_s(view, course))
    return Job(SUPPORTER if rank == 1 else DEFENDER, found[rank - 1])

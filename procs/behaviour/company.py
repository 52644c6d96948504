"""Mates without a radio: whether they are about, and keep the goal, and the job of a robot that hears none of them."""

import math
from collections.abc import Container, Mapping

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
_KEEPS_S = 2.0  # a goalkeeper that is seen now and then stays one
_PLAYS_M_S = 0.3  # a robot that was never faster may be out of order
_STAY_S = 0.3  # an attacker keeps its role unless a mate is so much faster at the ball


class Company:
    """Tells a robot whether it is alone, and whether a mate that it does not hear keeps the goal.

    Call each method once a tick.
    """

    def __init__(self) -> None:
        self._unseen_s = math.inf
        self._heard: set[str] = set()  # the mates that were heard last, unless one was seen since
        self._unkept_s = math.inf

    def watch(self, view: View, duration_s: float, sent_off: Container[str] = ()) -> bool:
        """Returns whether the robot hears no mate that plays, but has heard one or seen one drive lately.

        Mates that were heard last and sent off since are no company.
        """
        hears = {mate.name for mate in view.mates if mate.role != ABSENT}
        sees = any(math.hypot(*mate.velocity_m_s) > _PLAYS_M_S for mate in view.silent_mates)
        self._unseen_s = 0.0 if hears or sees else self._unseen_s + duration_s
        if hears or sees:
            self._heard = hears
        gone = bool(self._heard) and all(name in sent_off for name in self._heard)
        return not hears and not gone and self._unseen_s < _REMEMBERED_S

    def goal_is_kept(
        self, view: View, field: Field, players: Mapping[str, Player], sent_off: Container[str], duration_s: float
    ) -> bool:
        """Returns whether the lowest number of the players is not heard, but a silent mate is in the penalty area."""
        seen = any(field.in_penalty_area(*mate.place, -1.0) for mate in view.silent_mates)
        self._unkept_s = 0.0 if seen else self._unkept_s + duration_s
        if self._unkept_s >= _KEEPS_S:
            return False
        heard = {robot.number for robot in (view.own, *view.mates)}
        return min(_numbers(view.own.name, players, sent_off), default=view.own.number) not in heard


def rank_of(robot: str, players: Mapping[str, Player], sent_off: Container[str] = ()) -> int:
    """Returns how many players of the robot's team have a lower number, without those that were sent off."""
    own = number_of_player(robot, players)
    return sum(number < own for number in _numbers(robot, players, sent_off))


def _numbers(robot: str, players: Mapping[str, Player], sent_off: Container[str]) -> list[int]:
    """Returns the numbers of the players of a robot's team, without those that were sent off."""
    team = team_of_player(robot, players)
    return [player.number for name, player in players.items() if player.team == team and name not in sent_off]


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

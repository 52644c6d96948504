"""Robots that should drive but stand, such as held or broken ones, by what the team tells."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from procs.behaviour.game import Game, Whose
from procs.behaviour.goals import Goals
from procs.behaviour.roles import ATTACKER, DEFENDER, ROLLS_M_S, SUPPORTER, Job
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point

_STANDS_S = 2.5  # a healthy robot has driven off, or has kicked, by then
_MOVED_M = 0.3  # noise of the localization moves a standing robot by less
_AVOIDED_S = 10.0  # then the robot may have been repaired
_RIVAL_M = 0.5  # beside the ball; robots that fight for it stand, too
_AWAY_M = 3.0  # a robot that makes room for a shot stands less far from its place ...
_MARKED_M = 1.5  # ... and one that marks a rival stands nearer to the rival
_KEEPERS_M = 1.0  # around the own penalty area the attacker leaves the ball to the goalkeeper

NO_JOBS: Mapping[str, Job] = MappingProxyType({})


@dataclass
class _Stand:
    place: Point
    """Place of the robot when the time began."""
    time_s: float = 0.0
    """Time for which the robot should have driven, and stood."""
    avoided_s: float = 0.0
    """Time for which the team still does without the robot."""


class Stalls:
    """Tells a robot which robots of its team, itself among them, stand though they should go for the ball or elsewhere.

    All robots of a team hear the same messages, so that they find the same ones within the delay of a message.
    """

    def __init__(self) -> None:
        self._stands: dict[str, _Stand] = {}

    def watch(
        self, view: View, game: Game, field: Field, duration_s: float, jobs: Mapping[str, Job] = NO_JOBS
    ) -> frozenset[str]:
        """Returns the names of the stalled robots; call it once a tick, `duration_s` after the last.

        A robot stays stalled until it moves, or has had no reason to drive for 10 s. `jobs` are those of the last tick.
        """
        obliged, team = _ball_waits(view, game, field), {robot.name: robot for robot in (*view.mates, view.own)}
        self._stands = {name: self._standing(robot) for name, robot in team.items()}
        for name, robot in team.items():
            stand = self._stands[name]
            stand.avoided_s -= duration_s
            waits = bool(robot.agreement.passer)
            owes = obliged if robot.role == ATTACKER else _is_away(robot, jobs.get(name), view, game)
            if owes and not waits:
                stand.time_s += duration_s
            elif not waits or robot.role == ATTACKER:
                stand.time_s = 0.0
            if stand.time_s > _STANDS_S:
                stand.avoided_s = _AVOIDED_S
        return frozenset(name for name, stand in self._stands.items() if stand.avoided_s > 0.0)

    def _standing(self, robot: Robot) -> _Stand:
        """Returns what is known of a robot at its place; nothing, once it has moved."""
        stand = self._stands.get(robot.name)
        if stand is None or math.dist(stand.place, robot.place) > _MOVED_M:
            return _Stand(robot.place)
        return stand


def _ball_waits(view: View, game: Game, field: Field) -> bool:
    """Returns whether the ball lies where nothing but the attacker's own drive brings it to the attacker."""
    ball = view.ball
    allowed = game.free_play or (game.whose is Whose.OURS and not game.stopped)
    lies = ball.known and ball.speed_m_s < ROLLS_M_S and not view.is_at_ball(view.opponents, _RIVAL_M)
    if not allowed or not lies or field.in_penalty_area(*ball.place, -1.0, _KEEPERS_M):
        return False
    nearest = Goals(field, view.bodies).outside_areas(ball.place)  # in the rivals' goal area the ball is out of reach
    return math.dist(nearest, ball.place) <= view.bodies.held_ball_m


def _is_away(robot: Robot, job: Job | None, view: View, game: Game) -> bool:
    """Returns whether a robot without the ball is far from its place, and has no reason to stand there."""
    if game.paused or not view.ball.known or job is None:
        return False
    helps = robot.role in (SUPPORTER, DEFENDER) and job.role in (SUPPORTER, DEFENDER)
    marks = any(math.dist(robot.place, other.place) < _MARKED_M for other in view.opponents)
    return helps and not marks and math.dist(robot.place, job.place) > _AWAY_M

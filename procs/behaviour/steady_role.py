"""Steadiness of a robot's role: with each touch of a contested ball another robot is the first to meet it."""

from procs.behaviour.roles import ATTACKER, DEFENDER, HAS_BALL_M, SUPPORTER, Job
from procs.behaviour.view import View
from procs.model.field import Point

_SETTLES_S = 0.3
"""A role of the field is taken once it has been assigned for so long without a break."""
_FIELD_ROLES = {ATTACKER, SUPPORTER, DEFENDER}


class SteadyRole:
    """Keeps the role of one robot in play until another one has been assigned for a while."""

    def __init__(self) -> None:
        self._kept = Job("", Point(0.0, 0.0))
        self._other_s = 0.0  # another role than the kept one has been assigned

    def job(self, assigned: Job, view: View, free_play: bool, duration_s: float) -> Job:
        """Returns the job in this tick, `duration_s` after the last; that of the last role while another settles."""
        same = assigned.role == self._kept.role
        self._other_s = 0.0 if same else self._other_s + duration_s
        waits = free_play and _FIELD_ROLES.issuperset((assigned.role, self._kept.role)) and self._other_s < _SETTLES_S
        if same or not waits or _urgent(assigned, view):
            self._kept, self._other_s = assigned, 0.0
        elif self._kept.role == ATTACKER:
            self._kept = Job(ATTACKER, view.ball.place)
        return self._kept


def _urgent(assigned: Job, view: View) -> bool:
    """Returns whether the robot has to attack at once: as the only one, as receiver of a pass, or with the ball."""
    if assigned.role != ATTACKER:
        return False
    alone = all(mate.role != ATTACKER for mate in view.mates)
    return alone or bool(view.own.agreement.passer) or view.is_at_ball((view.own,), HAS_BALL_M)

"""Passes agreed between two robots through the messages of the team: announced, accepted, or dropped after a time-out.

The robot with the ball announces to which mate it would pass, before it passes. That mate accepts, stops and looks at
the ball, and the passer waits until it stands. A pass to a mate that has not accepted in time is dropped, and that mate
is not asked for a while. Both keep to the pass until the ball has arrived.
"""

import math
from collections.abc import Container

from procs.behaviour.view import Agreement, Robot, View
from procs.model.field import Field, Point

ANSWER_S = 0.5
"""An announced pass that is not accepted for longer is dropped: the way to the mate and back takes 0.2 s to 0.4 s."""
_REFUSED_S = 1.5  # for so long the mate is not asked again
_FLIGHT_S = 2.5  # a pass has arrived by then, or got lost
_TAKEN_M = 0.06  # a robot with the ball so near to its body has it
_STANDS_M_S = 0.5  # a slower receiver stands, as far as its mates know ...
_STOPS_S = 0.4  # ... and has stopped so long after its answer
_BESIDE_FIELD_M = 0.1  # a receiver may stand so far outside: the ball reaches its mouth in the field

_NOWHERE = Point(0.0, 0.0)


class Passing:
    """Agreement of one robot about a pass; call `watch` once a tick, and `announce` while the robot has the ball."""

    def __init__(self) -> None:
        self.said = Agreement()
        """Agreement that the team is told in this tick."""
        self.stalled: Container[str] = ()
        """Mates that stand though they should drive; they get no pass."""
        self.accepted = False
        """Whether the mate to which a pass is announced waits for it."""
        self.stands = False
        """Whether that mate has accepted, and stands."""
        self._asked_s = self._accepted_s = 0.0
        self._flight_s = math.inf
        self._refused_s: dict[str, float] = {}

    @property
    def late(self) -> bool:
        """Whether the mate to which a pass is announced has not answered in time."""
        return bool(self.said.receiver) and not self.accepted and self._asked_s > ANSWER_S

    def may_ask(self, mate: Robot) -> bool:
        """Returns whether a pass may be announced to a mate: it has not lately left one without an answer."""
        return mate.name not in self._refused_s

    def is_fit(self, mate: Robot, field: Field) -> bool:
        """Returns whether a mate can take a pass: it is in the field, and does not stand though it should drive."""
        return mate.name not in self.stalled and field.in_field(*mate.place, _BESIDE_FIELD_M)

    def watch(self, view: View, holds_ball: bool, duration_s: float) -> None:
        """Takes the words of the mates, `duration_s` after the last."""
        left_s = {mate: time_s - duration_s for mate, time_s in self._refused_s.items()}
        self._refused_s = {mate: time_s for mate, time_s in left_s.items() if time_s > 0.0}
        self._flight_s = 0.0 if holds_ball else self._flight_s + duration_s
        lost = taken(view)
        own = view.own.name
        if not holds_ball and (lost or self._flight_s > _FLIGHT_S or _arrived(view, self.said.receiver)):
            self.announce("")
        self._asked_s += duration_s
        receiver = next((mate for mate in view.mates if mate.name == self.said.receiver), None)
        self.accepted = receiver is not None and receiver.agreement.passer == own
        self._accepted_s = self._accepted_s + duration_s if self.accepted else 0.0
        slow = receiver is not None and math.hypot(*receiver.velocity_m_s) < _STANDS_M_S
        self.stands = self.accepted and (slow or self._accepted_s > _STOPS_S)
        self.said = self.said._replace(passer="" if holds_ball or lost else _announcer(view))

    def announce(self, receiver: str, place: Point = _NOWHERE) -> None:
        """Announces a pass to a mate at its place; an empty name takes the announcement back."""
        if receiver != self.said.receiver:
            self._asked_s = self._accepted_s = 0.0
            self.accepted = self.stands = False
        self.said = self.said._replace(receiver=receiver, place=place)

    def drop(self) -> None:
        """Takes the announcement back, and leaves the mate alone for a while."""
        self._refused_s[self.said.receiver] = _REFUSED_S
        self.announce("")


def _announcer(view: View) -> str:
    """Returns the mate that announces a pass to the own robot, of several the nearest to the ball."""
    asking = [mate for mate in view.mates if mate.agreement.receiver == view.own.name]
    nearest = min(asking, key=lambda mate: (math.dist(mate.place, view.ball.place), mate.name), default=None)
    return nearest.name if nearest else ""


def _arrived(view: View, receiver: str) -> bool:
    return view.is_at_ball((mate for mate in view.mates if mate.name == receiver), _TAKEN_M)


def taken(view: View) -> bool:
    """Returns whether an opponent has the ball."""
    return view.is_at_ball(view.opponents, _TAKEN_M)

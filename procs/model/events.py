"""Events of a tick for the referee: goals, balls out of the field, touches, kicks, collisions."""

from enum import IntEnum
from typing import NamedTuple


class Kind(IntEnum):
    """Kinds of events, in the order in which a tick reports them; the numbers are those of the message."""

    GOAL = 1
    OUT_SIDE = 2
    OUT_END = 3
    TOUCH = 4
    COLLISION = 5
    KICK = 6


class Event(NamedTuple):
    """One event. Sorting puts the events of a tick into an order that does not depend on the physics engine."""

    kind: Kind
    robot: str
    other: str
    x_m: float
    y_m: float
    speed_m_s: float

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
    """Name of the robot that touched or kicked the ball, of the last one that touched it before a goal or an out, or of
    the faster one in a collision."""
    other: str
    """Name of the slower robot in a collision; otherwise empty."""
    x_m: float
    """Place of the ball, or of the collision, world frame."""
    y_m: float
    speed_m_s: float
    """Speed of the ball, or the closing speed of a collision."""

"""Order of an agent: a skill and its target."""

from typing import NamedTuple

from procs.model.field import Point


class Order(NamedTuple):
    """A skill and its target in the attack frame."""

    skill: str
    place: Point = Point(0.0, 0.0)
    heading_rad: float = 0.0
    intention: str = ""
    """Purpose of the order in words, for people and team mates."""
    speed_m_s: float = 0.0
    """Limit of the drive, or the speed of a passed ball at its target; 0.0 leaves the speed to the skill."""
    receiver: str = ""
    """Mate for whom a pass is meant."""

"""Fouls, and the input of every rule."""

from typing import NamedTuple

from procs.model.field import Point
from procs.model.teams import Ends, Team
from procs.referee.reasons import Reason
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.touches import Carrier, Touches


class Foul(NamedTuple):
    """Breach of a rule by a robot."""

    robot: str
    reason: Reason
    place: Point
    """Place of the free kick."""
    direct: bool = False
    """In the own penalty area it brings a penalty."""


class Scene(NamedTuple):
    """A tick of play as the rules see it."""

    duration_s: float
    sight: Sight
    rules: Rules
    ends: Ends
    touches: Touches
    carrier: Carrier
    lost_by: Team = Team.NONE
    """Team that has put the ball out of the field in this tick, so that the other team restarts the game."""

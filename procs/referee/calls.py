"""Decisions of the referee, for the record of the match."""

from typing import NamedTuple

from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.cards import Card
from procs.referee.reasons import Reason


class Call(NamedTuple):
    """Decision of the referee: a goal, a card, a robot off the field, or else a whistle."""

    state: State
    team: Team
    goal: bool = False
    """By `team`."""
    robot: str = ""
    """Robot that committed a foul, got the card, or leaves the field."""
    card: Card = Card.NONE
    reason: Reason | None = None

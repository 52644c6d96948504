"""Cards, and the robots that are off the field for a while (2016, law 12; times of the RefBox)."""

import math
from collections import Counter
from enum import IntEnum

from procs.referee.rules import Rules


class Card(IntEnum):
    """Cards; the numbers are those of the message."""

    NONE = 0
    YELLOW = 1
    DOUBLE_YELLOW = 2
    RED = 3


class Cards:
    """Fouls and cards of every robot."""

    def __init__(self) -> None:
        self._fouls: Counter[str] = Counter()
        self._yellow: set[str] = set()
        self._out_s: dict[str, float] = {}

    @property
    def sent_off(self) -> frozenset[str]:
        """Robots that have to leave the field, or stay away from it."""
        return frozenset(self._out_s)

    @property
    def warned(self) -> frozenset[str]:
        """Robots with a yellow card."""
        return frozenset(self._yellow)

    @property
    def dismissed(self) -> frozenset[str]:
        """Robots that do not come back in this match."""
        return frozenset(robot for robot, time_s in self._out_s.items() if math.isinf(time_s))

    def pass_time(self, duration_s: float) -> None:
        """Lets time go by; robots whose time is over may come back."""
        left_s = {robot: time_s - duration_s for robot, time_s in self._out_s.items()}
        self._out_s = {robot: time_s for robot, time_s in left_s.items() if time_s > 0}

    def foul(self, robot: str, rules: Rules) -> Card:
        """Counts a foul; returns the card that it brings: a yellow card, then a double yellow one, in turns."""
        self._fouls[robot] += 1
        if self._fouls[robot] % rules.fouls_per_card:
            return Card.NONE
        return self.show(robot, Card.YELLOW, rules)

    def show(self, robot: str, card: Card, rules: Rules) -> Card:
        """Shows a card and returns it: a second yellow one is double; a red one is for the rest of the match."""
        if card is Card.YELLOW and robot in self._yellow:
            card = Card.DOUBLE_YELLOW
        if card is Card.YELLOW:
            self._yellow.add(robot)
        else:
            self._yellow.discard(robot)
            self.take_out(robot, math.inf if card is Card.RED else rules.double_yellow_s)
        return card

    def take_out(self, robot: str, time_s: float) -> None:
        """Takes a robot off the field for a time."""
        self._out_s[robot] = max(time_s, self._out_s.get(robot, 0.0))

"""Reasons in the history of a match: fouls, goals that do not count, and commands by hand, named as by the RefBox."""

from enum import StrEnum


class Reason(StrEnum):
    """Reason of a whistle; the text is that of the message."""

    COLLISION = "collision"
    PUSHING = "pushing"
    HOLDING = "holding"
    DRIBBLING = "dribbling"
    DOUBLE_TOUCH = "double touch"
    IN_GOAL_AREA = "goal area"
    TOO_MANY_IN_AREA = "too many in an area"
    TOO_LONG_IN_AREA = "too long in an area"
    EARLY_TOUCH = "touch before the set piece was taken"
    TOO_NEAR = "too near to a set piece"
    WRONG_HALF = "in the other half before the kick-off"
    KEEPER_LEFT = "keeper left its area before the penalty"
    DEADLOCK = "deadlock"
    NOT_TAKEN = "penalty not taken in time"
    MISSED = "missed"
    OWN_GOAL = "own goal straight from a set piece"
    OWN_HALF = "shot from the own half"
    NO_SECOND_ROBOT = "no second robot touched the ball"
    NOT_FREE = "the ball of the set piece did not roll freely"
    NO_PASS = "no pass since the ball was won in the own half"
    BY_HAND = "by hand"
    SUBGOAL = "subgoal"
    """A goal was taken back."""
    REPAIR = "repair"
    SUBSTITUTION = "substitution"
    PARK = "park"
    RESET = "reset"
    """The match begins anew, with this whistle."""


REPAIRS = (Reason.REPAIR, Reason.SUBSTITUTION)
"""One robot leaves the field without a card."""
OFF_FIELD = frozenset({*REPAIRS, Reason.PARK})
"""The same, or all robots with `park`."""

"""Parts of a match: two halves, two halves of overtime, penalties."""

from collections.abc import Mapping

from procs.model.teams import Ends, Team
from procs.referee.rules import Rules

FIRST, SECOND, THIRD, FOURTH, PENALTIES = 1, 2, 3, 4, 5
"""Numbers of the parts: halves, halves of the overtime, penalties."""


def length_s(half: int, rules: Rules) -> float:
    """Returns the length of a half."""
    return rules.half_s if half <= SECOND else rules.overtime_half_s


def after(half: int, score: Mapping[Team, int], rules: Rules) -> int | None:
    """Returns the half that follows; None if the match has ended."""
    if half in (FIRST, THIRD):
        return half + 1
    drawn = score[Team.CYAN] == score[Team.MAGENTA]
    return half + 1 if rules.decide and drawn and half < PENALTIES else None


def kicks_off(half: int, rules: Rules) -> Team:
    """Returns the team that begins a part: the odd ones that of the first kick-off, the even ones the other."""
    first = Team[rules.first_kick_off.upper()]
    return first if half % 2 else first.other


def ends_of(half: int, rules: Rules) -> Ends:
    """Returns the ends that the teams defend in a half."""
    return Ends(1.0) if rules.change_ends and half in (SECOND, FOURTH) else Ends()

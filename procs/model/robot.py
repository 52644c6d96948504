"""Team and number in a robot's name: `cyan3` is number 3 of team cyan, which defends the goal at negative x."""

import re

CYAN, MAGENTA = "cyan", "magenta"
RADIUS_M = 0.25
"""Of the round robots of the middle size league."""

_NAME = re.compile(r"(.*?)(\d*)")


def team_of(robot: str) -> str:
    """Returns the letters before the number: `cyan3` gives `cyan`."""
    found = _NAME.fullmatch(robot)
    return found[1] if found else robot


def number_of(robot: str) -> int:
    """Returns the number at the end of the name; 0 for a name without a number."""
    found = _NAME.fullmatch(robot)
    return int(found[2]) if found and found[2] else 0


def side_of(team: str) -> float:
    """Returns the side of the goal that the team defends: +1.0 for magenta, -1.0 for cyan and for any other team."""
    return 1.0 if team == MAGENTA else -1.0

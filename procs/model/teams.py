"""Teams, and the goals that they defend."""

import math
from collections.abc import Mapping
from enum import IntEnum
from typing import NamedTuple

from procs.model.robot import MAGENTA, Player, team_of, team_of_player


class Team(IntEnum):
    """Teams; the numbers are those of the message."""

    NONE = 0
    CYAN = 1
    MAGENTA = 2

    @property
    def other(self) -> "Team":
        """The other team; NONE for NONE."""
        return Team(3 - self) if self else self


class Ends(NamedTuple):
    """Ends of the field; the teams change them for the second half."""

    cyan_side: float = -1.0
    """Side of the goal that cyan defends: -1.0 or 1.0."""

    @classmethod
    def told(cls, cyan_side: float) -> "Ends":
        """Returns the ends that the message of the referee states; the usual ones if it states none, with 0."""
        return cls(math.copysign(1.0, cyan_side)) if cyan_side else cls()

    def side_of(self, team: Team) -> float:
        """Returns the side of the goal that a team defends; 0.0 for NONE."""
        return (0.0, self.cyan_side, -self.cyan_side)[team]

    def defender(self, side: float) -> Team:
        """Returns the team that defends the goal on a side, given by a number of its sign."""
        return Team.CYAN if side * self.cyan_side > 0 else Team.MAGENTA


def team_number(robot: str) -> Team:
    """Returns the team of a robot; NONE for the empty name."""
    if not robot:
        return Team.NONE
    return Team.MAGENTA if team_of(robot) == MAGENTA else Team.CYAN


def team_number_of_player(robot: str, players: Mapping[str, Player]) -> Team:
    """Returns the team of a robot by its namespace; a robot that is not among the players has the team of its name."""
    return team_number(team_of_player(robot, players))

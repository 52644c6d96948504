"""Team and number of a robot, as the launch file states them for the players of the match."""

from collections.abc import Mapping

from lcmtypes.soccer import mate_estimate_t
from procs.model.robot import Player, number_of
from procs.model.teams import Team, team_number


def team_of_player(robot: str, players: Mapping[str, Player]) -> Team:
    """Returns the team of a robot by its namespace; a robot that is not among the players has the team of its name."""
    player = players.get(robot)
    return Team[player.team.upper()] if player else team_number(robot)


def number_of_player(robot: str, players: Mapping[str, Player]) -> int:
    """Returns the number of a robot by its namespace; without a player of that name, the number in the name."""
    player = players.get(robot)
    return player.number if player else number_of(robot)


def number_of_mate(mate: mate_estimate_t, players: Mapping[str, Player]) -> int:
    """Returns the number of a mate that the world model states, or else that of the player."""
    return mate.number or number_of_player(mate.name, players)

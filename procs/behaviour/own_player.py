"""Check of the setting `players` by components that act for one of the players."""

from pydantic import ValidationInfo

from procs.model.robot import CYAN, MAGENTA, Players, player_of


def with_own_robot(players: Players, info: ValidationInfo, port: str) -> Players:
    """Refuses players without the robot in whose namespace the channel of a port is, as soon as that is known."""
    robot = info.context["channels"][port][0].rpartition("/")[0] if info.context else ""
    if robot and player_of(robot, players) is None:
        raise ValueError(
            f"{robot} is not a player; add players.{robot} under 'shared:', such as {{team: {CYAN}, number: 1}}, or"
            f" name the robot by its team, {CYAN} or {MAGENTA}, and its number, such as {CYAN}1"
        )
    return players

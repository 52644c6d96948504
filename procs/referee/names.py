"""Names of robots: the referee calls a robot by its team and number, such as `cyan1`, whatever its namespace."""

from collections.abc import Collection, Iterable, Mapping

from procs.model.robot import CYAN, MAGENTA, Player, number_of, team_of


class Names:
    """Translates between namespaces, such as `anna`, and the referee's names, such as `cyan1`."""

    def __init__(self, players: Mapping[str, Player]) -> None:
        """Robots that are not among the players are known by their namespaces, if those are a team and a number."""
        self._player_names = {namespace: f"{player.team}{player.number}" for namespace, player in players.items()}
        self._namespaces = {name: namespace for namespace, name in self._player_names.items()}

    def learn(self, robots: Iterable[str]) -> None:
        """Takes the namespaces on the field: of players that share team and number, the player on the field counts."""
        self._namespaces |= {self._player_names[robot]: robot for robot in robots if robot in self._player_names}

    def of_player(self, robot: str) -> str:
        """Returns the referee's name for a namespace; empty for a robot that plays in neither team."""
        if robot in self._player_names:
            return self._player_names[robot]
        plays = team_of(robot) in (CYAN, MAGENTA) and number_of(robot) > 0 and robot not in self._namespaces
        return robot if plays else ""

    def namespace(self, robot: str) -> str:
        """Returns the namespace of a robot that has one of the referee's names."""
        return self._namespaces.get(robot, robot)

    def namespaces(self, robots: Collection[str]) -> list[str]:
        """Returns the namespaces of robots, sorted."""
        return sorted(map(self.namespace, robots))

"""Names of the robots: within the referee a robot is called by team and number, whatever its namespace."""

from collections.abc import Collection, Iterable, Mapping

from procs.model.robot import CYAN, MAGENTA, Player, number_of, team_of


class Names:
    """Translates between namespaces, such as `anna`, and the referee's names, such as `cyan1`."""

    def __init__(self, players: Mapping[str, Player]) -> None:
        """Robots that are not among the players are known by their namespaces, if those are a team and a number."""
        self._inside = {name: f"{player.team}{player.number}" for name, player in players.items()}
        self._outside = {inside: name for name, inside in self._inside.items()}

    def meet(self, robots: Iterable[str]) -> None:
        """Takes the namespaces on the field: of players that share team and number, the one that is there counts."""
        self._outside |= {self._inside[robot]: robot for robot in robots if robot in self._inside}

    def inside(self, robot: str) -> str:
        """Returns the referee's name of a robot; empty for one that plays in neither team."""
        if robot in self._inside:
            return self._inside[robot]
        plays = team_of(robot) in (CYAN, MAGENTA) and number_of(robot) > 0 and robot not in self._outside
        return robot if plays else ""

    def outside(self, robot: str) -> str:
        """Returns the namespace of a robot that has one of the referee's names."""
        return self._outside.get(robot, robot)

    def all_outside(self, robots: Collection[str]) -> list[str]:
        """Returns the namespaces of robots, sorted."""
        return sorted(map(self.outside, robots))

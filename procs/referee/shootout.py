"""Penalties after a drawn overtime: the teams shoot in turns until one cannot be caught any more (2016)."""

from procs.referee.ends import Team


class Shootout:
    """Score of the penalties; cyan shoots first."""

    def __init__(self, pairs: int) -> None:
        self.pairs = pairs
        self.shots = {Team.CYAN: 0, Team.MAGENTA: 0}
        self.goals = {Team.CYAN: 0, Team.MAGENTA: 0}

    @property
    def shooter(self) -> Team:
        """Team of the next penalty."""
        return Team.CYAN if self.shots[Team.CYAN] == self.shots[Team.MAGENTA] else Team.MAGENTA

    @property
    def decided(self) -> bool:
        """True if the team behind cannot draw level in the penalties that are left."""
        left = {team: max(self.pairs, *self.shots.values()) - self.shots[team] for team in self.shots}
        ahead = max(self.goals, key=lambda team: self.goals[team])
        return self.goals[ahead] > self.goals[ahead.other] + left[ahead.other]

    def shot(self, scored: bool) -> None:
        """Counts a penalty of the team whose turn it is."""
        team = self.shooter
        self.shots[team] += 1
        self.goals[team] += scored

    def take_back(self, team: Team) -> None:
        """Counts one of a team's goals as a miss, if it has any."""
        self.goals[team] = max(0, self.goals[team] - 1)

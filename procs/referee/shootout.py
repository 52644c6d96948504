"""Penalties after a drawn overtime: the teams shoot in turns until one cannot be caught any more (2016)."""

from procs.referee.ends import Team


class Shootout:
    """Score of the penalties."""

    def __init__(self, pairs: int, first: Team = Team.CYAN) -> None:
        """`first` shoots first."""
        self.pairs = pairs
        self.shooter = first
        """Team of the next penalty: the one with fewer shots, unless a person lets another shoot."""
        self._first = first
        self.shots = {Team.CYAN: 0, Team.MAGENTA: 0}
        self.goals = {Team.CYAN: 0, Team.MAGENTA: 0}

    @property
    def decided(self) -> bool:
        """True if the team behind cannot draw level in the penalties that are left."""
        left = {team: max(self.pairs, *self.shots.values()) - self.shots[team] for team in self.shots}
        ahead = max(self.goals, key=lambda team: self.goals[team])
        return self.goals[ahead] > self.goals[ahead.other] + left[ahead.other]

    def shot(self, scored: bool) -> None:
        """Counts a penalty of the team whose turn it is."""
        self.shots[self.shooter] += 1
        self.goals[self.shooter] += scored
        ahead = self.shots[self._first] > self.shots[self._first.other]
        self.shooter = self._first.other if ahead else self._first

    def take_back(self, team: Team) -> None:
        """Counts one of a team's goals as a miss, if it has any."""
        self.goals[team] = max(0, self.goals[team] - 1)

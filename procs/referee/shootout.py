"""Penalties after a drawn overtime: the teams shoot in turn until one of them cannot be caught any more (2016)."""

from procs.model.events import Kind
from procs.model.teams import Team, team_number
from procs.referee.fouls.foul import Scene
from procs.referee.restarts import Restart
from procs.referee.sight import LEAVES
from procs.referee.stretch import Stretch


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


def penalty_scored(scene: Scene, stretch: Stretch, penalty: Restart, time_s: float, reach_s: float) -> bool | None:
    """Returns whether a penalty is scored or missed, `time_s` after its start; None while it goes on.

    A goal, the ball out, a further touch or time ends it, also if no robot has reached the ball within `reach_s`. It is
    one shot: after it no robot of the shooting team may touch the ball, even if the goalkeeper has.
    """
    left = [event for event in scene.sight.events if event.kind in LEAVES]
    attacked = scene.ends.side_of(penalty.team.other)
    again = stretch.released and any(team_number(robot) is penalty.team for robot in scene.sight.touching)
    off_robot = all(event.robot for event in left)
    scored = off_robot and not again and any(event.kind is Kind.GOAL and event.x_m * attacked > 0 for event in left)
    stretch.rolled(scene.sight.ball, scene.rules)
    late = not stretch.taken and time_s >= reach_s
    missed = bool(left) or late or again or time_s >= scene.rules.shot_s
    return scored if scored or missed else None

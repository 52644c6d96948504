"""Advantage: a foul without contact does not stop the game while its victims have the ball (2016, law 5)."""

from procs.model.teams import Team, team_number
from procs.referee.fouls.foul import Foul, Scene


class Advantage:
    """Holds a foul back for some seconds, and lets it be punished if the other team gets the ball meanwhile."""

    def __init__(self) -> None:
        self._foul: Foul | None = None
        self._left_s = 0.0

    def pends(self, foul: Foul) -> bool:
        """Returns whether a foul of the same team is held back."""
        return self._foul is not None and team_number(self._foul.robot) is team_number(foul.robot)

    def grants(self, foul: Foul, scene: Scene) -> bool:
        """Holds a foul without contact back if that is of advantage, and returns whether it is."""
        if not _plays(scene, team_number(foul.robot).other):
            return False
        self._foul, self._left_s = foul, scene.rules.advantage_s
        return True

    def lost(self, scene: Scene) -> Foul | None:
        """Returns the foul that was held back, in the tick in which its victims lose the ball."""
        foul, self._left_s = self._foul, self._left_s - scene.duration_s
        if foul is None:
            return None
        lost = not _plays(scene, team_number(foul.robot).other)
        if lost or self._left_s <= 0.0:
            self._foul = None
        return foul if lost else None


def _plays(scene: Scene, team: Team) -> bool:
    """Returns whether only that team has touched the ball of late, and has not put it out of the field."""
    others = [robot for robot in scene.sight.touching if team_number(robot) is not team]
    return team_number(scene.touches.last) is team and not others and scene.lost_by is not team

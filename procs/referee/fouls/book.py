"""All rules against fouls in play, in the order in which a tick is judged."""

from procs.model.teams import team_number
from procs.referee.fouls.areas import Areas
from procs.referee.fouls.double_touch import double_touch
from procs.referee.fouls.dribbling import dribbling
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.fouls.holding import Holding
from procs.referee.fouls.pushing import Pushing, collisions


class RuleBook:
    """Judges every tick of play with a fresh memory after each restart."""

    def __init__(self) -> None:
        self._holding, self._areas, self._pushing = Holding(), Areas(), Pushing()

    def watch(self, scene: Scene) -> list[Foul]:
        """Returns the first foul of the tick, and with it one that the other team commits against the same rule."""
        found = [
            collisions(scene),
            self._pushing.watch(scene),
            _listed(double_touch(scene)),
            _listed(dribbling(scene)),
            _listed(self._holding.watch(scene)),
            self._areas.watch(scene),
        ]
        return _one_each(next(filter(None, found), []))


def grave_fouls(scene: Scene) -> list[Foul]:
    """Returns the fouls that end a set piece, too, one of each team at most."""
    return _one_each(collisions(scene) or _listed(dribbling(scene)))


def _one_each(fouls: list[Foul]) -> list[Foul]:
    """Returns the first of the fouls, and the first of the other team."""
    others = [foul for foul in fouls if team_number(foul.robot) is not team_number(fouls[0].robot)]
    return fouls[:1] + others[:1]


def _listed(foul: Foul | None) -> list[Foul]:
    return [foul] if foul else []

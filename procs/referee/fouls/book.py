"""All rules against fouls in play, in the order in which a tick is judged."""

from procs.referee.fouls.areas import Areas
from procs.referee.fouls.double_touch import double_touch
from procs.referee.fouls.dribbling import dribbling
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.fouls.holding import Holding
from procs.referee.fouls.pushing import Pushing, collision


class RuleBook:
    """Judges every tick of play with a fresh memory after each restart."""

    def __init__(self) -> None:
        self._holding, self._areas, self._pushing = Holding(), Areas(), Pushing()

    def watch(self, scene: Scene) -> Foul | None:
        """Returns the first foul of the tick."""
        found = [
            collision(scene),
            self._pushing.watch(scene),
            double_touch(scene),
            dribbling(scene),
            self._holding.watch(scene),
            self._areas.watch(scene),
        ]
        return next(filter(None, found), None)

"""A stretch of the game, from a start to the next interruption: the referee's memory of it."""

import math

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team
from procs.referee.advantage import Advantage
from procs.referee.fouls.book import RuleBook, grave_fouls
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.touches import Carrier, Touches


class Stretch:
    """Touches, fouls and rests of the ball since a set piece began."""

    def __init__(
        self, piece: State, team: Team, ball: Point, excused: frozenset[str] = frozenset(), keeper: str = ""
    ) -> None:
        """Begins with a set piece of a team, and the ball at a place; robots that it finds misplaced are `excused`.

        `keeper` is the goalkeeper that faces the set piece; empty without one.
        """
        self.piece = piece
        """Set piece at the beginning; PLAY if its team did not take it in its time."""
        self.team = team
        """Team that takes the set piece; NONE for a dropped ball."""
        self.excused = excused
        """Robots that no breach of the set piece is held against; those that come back to the field are added."""
        self.keeper = keeper
        self.touches = Touches(ball)
        self.released = False
        """The ball of the set piece has rolled so far that it was set free."""
        self.breached = False
        """A breach of the set piece was counted."""
        self.suffered: Foul | None = None
        """Foul of the defenders during a penalty, which is repeated unless its shot is a goal."""
        self._carrier = Carrier()
        self._book = RuleBook()
        self._advantage = Advantage()
        self._resting_at = ball  # where the ball was when it was last seen to move on
        self._resting_s = 0.0

    @property
    def taken(self) -> bool:
        """Whether a robot of the team that takes the set piece has touched the ball."""
        return self.touches.of_team(self.team)

    @property
    def penalty_rolls(self) -> bool:
        """Whether the ball of a penalty was shot in its time, and no robot has touched it since."""
        touches = self.touches
        shot = self.piece is State.PENALTY and self.released and not touches.overdue
        return shot and not touches.again and len(touches.robots) == 1

    def watch(self, duration_s: float, sight: Sight, ends: Ends, rules: Rules) -> Scene:
        """Takes a tick of `duration_s`, and returns it as the rules see it."""
        self.touches.watch(sight, ends, self.released, rules)
        self._carrier.watch(duration_s, sight, rules)
        self.touches.watch_rivals(duration_s, sight, self._carrier.robot, rules)
        return Scene(duration_s, sight, rules, ends, self.touches, self._carrier)

    def rolled(self, ball: Point, rules: Rules) -> bool:
        """Returns whether the ball has rolled without a touch far enough to be set free.

        Remembers that the team of a set piece has set it free: its taker may then not touch it again.
        """
        rolled = math.dist(ball, self.touches.place) >= rules.moved_m
        self.released = self.released or (self.taken and rolled and self.piece is not State.PLAY)
        return rolled

    def begin_play(self, ball: Point, late: Team) -> None:
        """Goes on as play, with or without the set piece having been taken; `late` is the team that did not in time."""
        self.touches.overdue = bool(late)
        if not self.touches.robots and self.piece is not State.DROP_BALL:
            self.piece, self.touches.late = State.PLAY, late
        self._resting_at, self._resting_s = ball, 0.0

    def fouls(self, scene: Scene, in_play: bool) -> tuple[list[Foul], list[Foul]]:
        """Returns the fouls that were committed in the tick, and those that are punished now.

        Only grave ones stop a set piece that is not `in_play` yet. In play contact always stops the game, also while
        another foul is held back; so do two teams at fault at once.
        """
        if not in_play:
            grave = grave_fouls(scene)
            return grave, grave
        fouls, lost = self._book.watch(scene), self._advantage.lost(scene)
        if len(fouls) > 1 or any(foul.direct for foul in fouls):
            return fouls, fouls
        held = [lost] if lost else []
        if not fouls or self._advantage.pends(fouls[0]):
            return [], held
        return fouls, held or ([] if self._advantage.grants(fouls[0], scene) else fouls)

    def deadlocked(self, scene: Scene) -> bool:
        """Returns whether the ball has stayed in its place for too long."""
        self._resting_s += scene.duration_s
        if math.dist(scene.sight.ball, self._resting_at) > scene.rules.deadlock_m:
            self._resting_at, self._resting_s = scene.sight.ball, 0.0
        return self._resting_s >= scene.rules.deadlock_s

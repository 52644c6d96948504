"""The ball of a set piece: its spot, the crew that puts it there, and where it was when play was stopped."""

import math
from collections.abc import Iterable

from procs.model.field import Field, Point
from procs.referee.rules import Rules

_MISPLACED_M = 0.6  # the crew may have to put the ball beside a robot; further away, a robot has pushed it
_BESIDE_M = 0.25  # a ball that rests further from its spot is put there as soon as no robot is in the way
_ROLLS_M_S = 0.2
_CREW_S = 0.5  # until the report shows a placement
_PATIENCE = 2  # pushed balls for which robots get their time anew; more would delay the game


class BallPlacing:
    """Placements of the ball by the crew; world frame."""

    def __init__(self, spot: Point) -> None:
        self.spot = spot
        """Place of the ball at the set piece."""
        self.number = 1
        """Number of the newest placement: with a higher number than before, the crew puts the ball on `spot`."""
        self.left_at: Point | None = None
        """Place of the ball when the game was last stopped."""
        self.laid_s = 0.0
        """Time that robots have had for their positions since the ball was put on its spot, or put back."""
        self.rolls = False
        """Whether the ball has moved since the tick before, because a robot touched it or the crew put it down."""
        self._before = spot
        self._since_s = 0.0
        self._put_back = 0

    def place(self, spot: Point) -> None:
        """Has the ball put on the spot."""
        self.spot = spot
        self.number += 1
        self.laid_s = self._since_s = 0.0
        self._put_back = 0

    def put_back(self) -> None:
        """Has the ball that a robot has pushed away put back on its spot."""
        self.number += 1
        self._since_s = 0.0
        self._put_back += 1
        if self._put_back <= _PATIENCE:
            self.laid_s = 0.0

    def watch(self, duration_s: float, ball: Point) -> None:
        """Watches the ball in a tick of a stoppage."""
        self._since_s += duration_s
        self.laid_s += duration_s
        self.rolls = math.dist(ball, self._before) > _ROLLS_M_S * duration_s
        self._before = ball

    def is_away(self, ball: Point, rules: Rules) -> bool:
        """Returns whether the ball is further from its spot than the crew may have to put it, or not in the field."""
        return math.dist(ball, self.spot) > _MISPLACED_M or not rules.field.in_field(*ball, rules.ball.radius_m)

    def is_under_way(self, ball: Point, rules: Rules) -> bool:
        """Returns whether the crew has not had the time to put the ball on its spot."""
        return self._since_s <= _CREW_S and self.is_away(ball, rules)

    def is_misplaced(self, ball: Point, robots: Iterable[Point], rules: Rules) -> bool:
        """Returns whether the crew has put the ball down, but it is not on its spot and can be put there.

        A robot has pushed it away, or it rests beside a robot that has left the spot meanwhile; that twice at most.
        """
        if self._since_s <= _CREW_S:
            return False
        if self.is_away(ball, rules):
            return True
        beside = self._put_back < _PATIENCE and not self.rolls and math.dist(ball, self.spot) > _BESIDE_M
        clear_m = rules.robot.radius_m + 2 * rules.ball.radius_m
        return beside and all(math.dist(each, self.spot) > clear_m for each in robots)

    def remember(self, ball: Point, field: Field) -> None:
        """Remembers the place of the ball in a running game; of a ball that is out, where it was first seen outside."""
        if self.left_at is None or field.in_field(*self.left_at) or field.in_field(*ball):
            self.left_at = ball

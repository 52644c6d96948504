"""A match as a script for the referee: where the ball and the robots are, and what touches what."""

from typing import Any

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle

TICK_S = 0.05
CYAN, MAGENTA = Team.CYAN, Team.MAGENTA
PLACES = {
    "cyan1": Point(-10.5, 0.0),
    "cyan2": Point(-4.0, 2.0),
    "cyan3": Point(-4.0, -2.0),
    "magenta1": Point(10.5, 0.0),
    "magenta2": Point(4.0, 2.0),
    "magenta3": Point(4.0, -2.0),
}


class Script:
    """Five lines of play instead of a simulator; `robots` may be moved at any time."""

    def __init__(self, **rules: Any) -> None:
        self.whistle = Whistle(Rules(**({"kick_off_stoppage_s": 0.5, "stoppage_s": 0.5, "positions_s": 2.0} | rules)))
        self.robots = dict(PLACES)
        self.ball = Point(0.0, 0.0)
        self.placed = 0
        self.reasons: list[str] = []
        """Reasons of all whistles."""

    @property
    def state(self) -> tuple[State, Team, bool]:
        """State, team and whether the game is stopped."""
        return self.whistle.state, self.whistle.team, self.whistle.stopped

    @property
    def score(self) -> tuple[int, int]:
        """Goals of cyan and magenta."""
        return self.whistle.score[CYAN], self.whistle.score[MAGENTA]

    def tick(self, *events: Event, **velocities: Point) -> None:
        """Runs a tick; the field crew places the ball at once."""
        if self.placed != self.whistle.placements:
            self.placed, self.ball = self.whistle.placements, self.whistle.spot
        self.whistle.step(TICK_S, Sight(self.ball, events, dict(self.robots), velocities))
        self.reasons += [call.reason for call in self.whistle.calls if call.reason]

    def wait(self, time_s: float) -> None:
        """Lets time go by."""
        for _ in range(round(time_s / TICK_S)):
            self.tick()

    def started(self) -> "Script":
        """Waits until the set piece may be taken."""
        while self.whistle.stopped:
            self.tick()
        return self

    def touch(self, robot: str, kind: Kind = Kind.TOUCH) -> None:
        """Runs a tick in which a robot touches the ball."""
        self.tick(Event(kind, robot, "", *self.ball, 1.0))

    def roll(self, x_m: float, y_m: float) -> None:
        """Lets the ball roll to a place, without a touch."""
        self.ball = Point(x_m, y_m)
        self.tick()

    def carry(self, robot: str, x_m: float, y_m: float = 0.0, speed_m_s: float = 2.0) -> None:
        """Lets a robot carry the ball along a straight line; the robot is 0.33 m behind the ball."""
        way_m = max(abs(x_m - self.ball.x_m), abs(y_m - self.ball.y_m))
        steps, start = max(1, round(way_m / speed_m_s / TICK_S)), self.ball
        side = -1.0 if robot.startswith("cyan") else 1.0
        for step in range(1, steps + 1):
            share = step / steps
            self.ball = Point(start.x_m + share * (x_m - start.x_m), start.y_m + share * (y_m - start.y_m))
            self.robots[robot] = Point(self.ball.x_m + side * 0.33, self.ball.y_m)
            self.touch(robot)
            if self.whistle.stopped:
                return

    def goal(self, x_m: float, by: str) -> None:
        """Lets the ball roll into a goal."""
        self.ball = Point(x_m, 0.3)
        self.tick(Event(Kind.GOAL, by, "", *self.ball, 5.0))

    def playing(self) -> "Script":
        """Cyan kicks off and passes; the ball is then at cyan3, near the centre."""
        self.started()
        self.touch("cyan2")
        self.roll(-1.0, 0.0)
        assert self.state[0] is State.PLAY
        self.touch("cyan3")
        return self

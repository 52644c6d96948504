"""A script of the referee as seen by one team, which attacks along +x whatever its colour and its end."""

import math
from collections.abc import Callable
from typing import NamedTuple

from procs.model.ball import BALL
from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.geometry import ahead, bearing_rad, between
from procs.model.robot import ROBOT
from procs.model.teams import Team
from procs.referee import restarts
from tests.procs.referee.script import PLACES, TICK_S, Script


class View(NamedTuple):
    """Way to see the field: which team is ours, which half is played, and whether left and right are exchanged."""

    ours: Team
    half: int
    left: float

    @property
    def name(self) -> str:
        """Returns the name of the view, for the test's name."""
        return f"{self.ours.name.lower()}-half{self.half}-{'left' if self.left > 0 else 'right'}"


VIEWS = [View(ours, half, left) for ours in (Team.CYAN, Team.MAGENTA) for half in (1, 2) for left in (1.0, -1.0)]


class Decision(NamedTuple):
    """Decision of the referee, as seen by our team."""

    state: State
    team: str
    """ours, theirs, or empty for both."""
    reason: str = ""
    spot: tuple[float, float] | None = None
    """Place of the ball for the set piece; None if it does not matter."""
    score: tuple[int, int] = (0, 0)


class Mirror:
    """Script whose robots are named our1 to our3 and their1 to their3; we have the kick-off."""

    def __init__(self, view: View) -> None:
        self.script = Script(deadlock_s=8.0, set_piece_s=7.0)
        whistle = self.script.whistle
        whistle.begin_half(view.half)
        self._ours = view.ours
        self._signs = (-whistle.ends.side_of(view.ours), view.left)
        for name, place in PLACES.items():
            seen = name.replace("cyan", "our").replace("magenta", "their")
            self.move(seen, *place)
        self.give(restarts.kick_off(view.ours))
        self.script.started()

    def give(self, restart: restarts.Restart) -> None:
        """Gives a set piece, in the field's own frame."""
        self.script.whistle.interrupt(restart)

    @property
    def ball(self) -> Point:
        """Place of the ball as we see it."""
        return self._turned(*self.script.ball)

    @property
    def stopped(self) -> bool:
        """Whether the game is stopped."""
        return self.script.whistle.stopped

    @property
    def decision(self) -> Decision:
        """The referee's last decision; its spot only while the game is stopped."""
        whistle = self.script.whistle
        team = {self._ours: "ours", self._ours.other: "theirs"}.get(whistle.team, "")
        reasons = self.script.reasons
        score = (whistle.score[self._ours], whistle.score[self._ours.other])
        spot = self._turned(*whistle.spot) if whistle.stopped else None
        return Decision(whistle.state, team, reasons[-1] if reasons else "", spot, score)

    def move(self, robot: str, x_m: float, y_m: float) -> None:
        """Puts a robot somewhere."""
        self.script.robots[self._named(robot)] = self._turned(x_m, y_m)

    def touch(self, robot: str, x_m: float | None = None, y_m: float = 0.0) -> None:
        """Runs a tick in which a robot touches the ball, there or where it is."""
        if x_m is not None:
            self.script.ball = self._turned(x_m, y_m)
        self.script.touch(self._named(robot))

    def roll(self, x_m: float, y_m: float = 0.0) -> None:
        """Runs a tick in which the ball is somewhere, without a touch."""
        self.script.roll(*self._turned(x_m, y_m))

    def wait(self, time_s: float) -> None:
        """Lets time go by."""
        self.script.wait(time_s)

    def happen(self, kind: Kind, robot: str, x_m: float, y_m: float, other: str = "", speed_m_s: float = 5.0) -> None:
        """Runs a tick with an event of the field."""
        place = self._turned(x_m, y_m)
        if kind is not Kind.COLLISION:
            self.script.ball = place
        self.script.tick(Event(kind, self._named(robot), self._named(other), *place, speed_m_s))

    def push(self, robot: str, rival: str, speed_m_s: float) -> None:
        """Runs a tick in which both robots drive along +x."""
        x_m_s = speed_m_s * self._signs[0]
        self.script.tick(**{self._named(name): Point(x_m_s, 0.0) for name in (robot, rival)})

    def carry(self, robot: str, x_m: float, y_m: float = 0.0, speed_m_s: float = 2.0) -> float:
        """Lets a robot carry the ball along a straight line until the whistle; returns the way in m."""
        start, end = self.ball, Point(x_m, y_m)
        whole_m, way_m = math.dist(start, end), 0.0
        while way_m < whole_m and not self.stopped:
            way_m = min(whole_m, way_m + speed_m_s * TICK_S)
            ball = between(start, end, way_m / whole_m)
            self.move(robot, *ahead(ball, bearing_rad(start, end), -ROBOT.held_ball_m(BALL)))
            self.touch(robot, *ball)
        return way_m

    def until_stopped(self, act: Callable[[], None], limit_s: float) -> float:
        """Repeats an act of one tick until the whistle; returns the time in s, or the limit."""
        for tick in range(round(limit_s / TICK_S)):
            if self.stopped:
                return tick * TICK_S
            act()
        return limit_s

    def play(self) -> None:
        """We kick off and pass: our3 has the ball, 1 m behind the centre."""
        self.touch("our2")
        self.roll(-1.0)
        self.touch("our3")
        assert self.script.whistle.state is State.PLAY

    def _named(self, robot: str) -> str:
        ours, theirs = (team.name.lower() for team in (self._ours, self._ours.other))
        return robot.replace("our", ours).replace("their", theirs)

    def _turned(self, x_m: float, y_m: float) -> Point:
        """Returns a place of our frame in the field's, or the other way round."""
        return Point(self._signs[0] * x_m, self._signs[1] * y_m)

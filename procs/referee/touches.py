"""History of the ball since the last restart: touches, passes, and the robot that carries it."""

import math

from procs.model.events import Kind
from procs.model.field import Point
from procs.model.teams import Ends, Team, team_number
from procs.referee.rules import Rules
from procs.referee.sight import Sight


class Touches:
    """Touches in a stretch of the game, from the placing of the ball to the next interruption."""

    def __init__(self, spot: Point) -> None:
        self.robots: set[str] = set()
        """Robots that touched the ball."""
        self.taker = ""
        """Robot that touched the ball first."""
        self.last = ""
        """Robot that touched the ball last; of several in a tick the one that the sight names."""
        self.place = spot
        """Place of the last touch; before the first, that of the ball."""
        self.bystander = ""
        """Robot that takes no part in the game and has touched the ball after all others; empty without one."""
        self.again = False
        """The taker has touched the ball again after a free roll, before another robot did."""
        self.double = False
        """The taker had mates on the field at that second touch."""
        self.late = Team.NONE
        """Team that did not take its set piece in time: it plays on, but a goal still needs a second robot."""
        self.passed = False
        """A robot of the taker's team has played the ball after it had rolled freely off a mate of it."""
        self.overdue = False
        """The time for the set piece was over before the ball was set free."""
        self.intercepted = False
        """A rival of the taker has carried or kicked the ball."""
        self._freed_by = ""  # the robot of the taker's team off which the ball rolled freely first
        self._rival_s = 0.0  # for which a rival carries it
        self.owes_pass = Team.NONE
        """Team that won the ball in its own half and has not passed it since."""

    def watch(self, sight: Sight, ends: Ends, released: bool, rules: Rules) -> None:
        """Takes the touches of a tick; `released`: the ball has been set free since the last touch of the taker."""
        for robot, place in sight.touching.items():
            if robot != self.last:
                self._won(robot, place, ends, rules.pass_m)
            if released or math.dist(place, self.place) >= rules.moved_m:
                self._received(robot)
            if released and robot == self.taker and self.robots == {robot} and not self.again:
                self.again, self.double = True, bool(sight.mates(robot))
            self.taker = self.taker or robot
            self.robots.add(robot)
            self.last, self.place, self.bystander = robot, place, ""
        self.bystander = sight.bystander or self.bystander

    def of_team(self, team: Team) -> bool:
        """Returns whether a robot of a team has touched the ball, also one that has left the field since."""
        return any(team_number(robot) is team for robot in self.robots)

    def watch_rivals(self, duration_s: float, sight: Sight, carrier: str, rules: Rules) -> None:
        """Notes whether rivals of the taker have had the ball; `carrier` is the robot that carries it now."""
        kickers = {event.robot for event in sight.events if event.kind is Kind.KICK}
        self._rival_s = self._rival_s + duration_s if self._is_rival(carrier) else 0.0
        won = self._rival_s > rules.won_s or any(map(self._is_rival, kickers))
        self.intercepted = self.intercepted or won

    def _received(self, robot: str) -> None:
        """Notes the touch of a ball that has rolled freely since the touch before, if a team mate set it free."""
        if not self._freed_by and self.last and not self._is_rival(self.last):
            self._freed_by = self.last
        self.passed = self.passed or (bool(self._freed_by) and robot != self._freed_by and not self._is_rival(robot))

    def _is_rival(self, robot: str) -> bool:
        return bool(robot and self.taker) and team_number(robot) is not team_number(self.taker)

    def _won(self, robot: str, place: Point, ends: Ends, pass_m: float) -> None:
        team, before = team_number(robot), team_number(self.last)
        if team is before:
            if math.dist(place, self.place) >= pass_m:
                self.owes_pass = Team.NONE
        else:
            in_own_half = place.x_m * ends.side_of(team) > 0
            self.owes_pass = team if before and in_own_half else Team.NONE


class Carrier:
    """Robot that keeps the ball at its body, alone, from tick to tick."""

    def __init__(self) -> None:
        self.robot = ""
        """Empty without one."""
        self.since = Point(0.0, 0.0)
        """Place at which it took the ball."""
        self._missing_s = 0.0
        self._place = self.since

    def watch(self, duration_s: float, sight: Sight, rules: Rules) -> None:
        """Takes the touches of a tick."""
        touching = sight.touching
        alone = min(touching) if len(touching) == 1 else ""
        self._missing_s = 0.0 if touching else self._missing_s + duration_s
        free = self._missing_s > rules.lost_s or math.dist(sight.ball, self._place) > rules.free_m
        if touching:
            self._place = sight.ball
        if alone != self.robot and (touching or free):
            self.robot, self.since = alone, touching.get(alone, sight.ball)

"""A match as its referee leads it: state, score and cards, and the acts that change them."""

from collections.abc import Iterable

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team, team_number
from procs.referee import halves, restarts
from procs.referee.ball_placing import BallPlacing
from procs.referee.calls import Call
from procs.referee.cards import Card, Cards
from procs.referee.line_up import misplaced_robots
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from procs.referee.shootout import Shootout
from procs.referee.sight import Sight
from procs.referee.stretch import Stretch


class Match:
    """State of a match; `calls` are the decisions of the newest tick."""

    def __init__(self, rules: Rules) -> None:
        self.rules = rules
        self.state, self.team, spot = restarts.kick_off(halves.kicks_off(halves.FIRST, rules))
        self.stopped = True
        """Robots take position; the ball is not to be touched."""
        self.held = False
        """The game stays stopped until it is started by hand."""
        self.started = False
        """The set piece at hand was started, though a person may have stopped it since."""
        self.half = halves.FIRST
        self.score = {Team.CYAN: 0, Team.MAGENTA: 0}
        self.ends = Ends()
        self.time_in_half_s = 0.0
        self.time_in_state_s = 0.0
        self.cards = Cards()
        self.shootout: Shootout | None = None
        self.calls: list[Call] = []
        self.awaited = Team.NONE
        """Team with too few robots, for which the set piece waits."""
        self._ball = BallPlacing(spot)
        self._begun = False  # whether a set piece of the half was started
        self._changing_ends = False
        self._starting = False  # the game starts as soon as the ball is on its spot
        self._repeats = 0  # of the set piece at hand, after breaches
        self._stretch = Stretch(self.state, self.team, spot)

    @property
    def over(self) -> bool:
        """Whether the match has ended."""
        return self.state is State.FROZEN

    @property
    def at_rest(self) -> bool:
        """Whether the match has a break, or has ended."""
        return self.state in (State.HALF_TIME, State.FROZEN)

    @property
    def standing(self) -> str:
        """The score for people, such as `cyan 1:0 magenta`."""
        return f"cyan {self.score[Team.CYAN]}:{self.score[Team.MAGENTA]} magenta"

    @property
    def drawn(self) -> bool:
        """Whether both teams have as many goals."""
        return self.score[Team.CYAN] == self.score[Team.MAGENTA]

    @property
    def spot(self) -> Point:
        """Place of the ball at the set piece; world frame."""
        return self._ball.spot

    @property
    def placements(self) -> int:
        """Number of placements so far: with a higher number than before, the ball is to be put on `spot`."""
        return self._ball.number

    @property
    def restart(self) -> Restart:
        """The set piece at hand."""
        return Restart(self.state, self.team, self.spot)

    def restart_place(self, ball: Point) -> Point:
        """Returns the place to which a set piece by hand belongs: where play was stopped, or else where the ball is."""
        return self._ball.left_at if self.stopped and self._ball.left_at else ball

    def begin_match(self) -> None:
        """Begins the match anew: no goals, no cards, the kick-off of the first half."""
        self.score = {Team.CYAN: 0, Team.MAGENTA: 0}
        self.cards = Cards()
        self.begin_half(halves.FIRST, Reason.RESET)

    def begin_half(self, half: int, reason: Reason | None = None, first: Team = Team.NONE) -> None:
        """Begins a half with its kick-off, or the penalties with the first one; `first` is the team that has it."""
        ends = halves.ends_of(half, self.rules)
        self._changing_ends, self.ends = self._changing_ends or ends != self.ends, ends
        self.half, self.time_in_half_s, self._ball.left_at = half, 0.0, None
        beginner = first or halves.kicks_off(half, self.rules)
        self.shootout = Shootout(self.rules.penalties, beginner) if half == halves.PENALTIES else None
        self.interrupt(self._next_penalty() if self.shootout else restarts.kick_off(beginner), reason)
        self._begun = False

    def kicks_off(self, half: int) -> Team:
        """Returns the team that was given the kick-off of a half that has not begun; NONE without one."""
        prepared = half == self.half and self.state is State.KICK_OFF and not self._begun
        return self.team if prepared else Team.NONE

    def stop(self, ball: Point) -> None:
        """Stops the game until it is started by hand; from play it goes on with a dropped ball.

        The ball is dropped where it is, but as far from goals and lines as a free kick is taken. That of a set piece
        is put back on its spot.
        """
        if not self.stopped:
            self._ball.remember(ball, self.rules.field)
        if self.state is State.PLAY:
            self.interrupt(restarts.ball_left_there(self._ball.left_at or ball, self.rules), Reason.BY_HAND)
        elif not self.at_rest:
            if not self.stopped and self._ball.is_away(ball, self.rules):
                self._ball.put_back()
            self._enter(self.state, self.team, stopped=True)
        self.held, self._starting = True, False

    def end_half(self) -> None:
        """Ends the half, and the match if no other follows."""
        if halves.after(self.half, self.score, self.rules):
            self._enter(State.HALF_TIME, Team.NONE, stopped=True)
            self.held = False
            self.calls.append(Call(self.state, Team.NONE))
        else:
            self.end_match()

    def end_match(self) -> None:
        """Ends the match, once."""
        if self.over:
            return
        self._enter(State.FROZEN, Team.NONE, stopped=True)
        self.calls.append(Call(self.state, Team.NONE))

    def interrupt(self, restart: Restart, reason: Reason | None = None, robot: str = "") -> None:
        """Stops the game for a set piece and has the ball placed."""
        self._repeats = 0
        self._enter(restart.state, restart.team, stopped=True)
        self.held = self.started = self._starting = False
        self.calls.append(Call(restart.state, restart.team, robot=robot, reason=reason))
        self._ball.place(restart.spot)

    def start(self, sight: Sight | None = None) -> None:
        """Lets the set piece be taken; waits for a ball that was just given to the crew."""
        waits = sight is not None and self._ball.is_under_way(sight.ball, self.rules)
        self._starting = self.stopped and waits
        if self._starting:
            return
        self._enter(self.state, self.team, stopped=False)
        self.held = self._changing_ends = False
        self.started = self._begun = True
        self._begin_stretch(sight)

    def goal(self, team: Team) -> None:
        """Counts a goal."""
        self.score[team] += 1
        self.calls.append(Call(State.KICK_OFF, team, goal=True))

    def take_back(self, team: Team) -> None:
        """Takes the newest goal of a team back, which has one; ends a match that is decided without it."""
        self.score[team] -= 1
        self.calls.append(Call(self.state, team, reason=Reason.SUBGOAL))
        if self.shootout:
            self.shootout.take_back(team)
            if self.shootout.decided and self.rules.automatic:
                self.end_half()

    def end_penalty(self, scored: bool) -> None:
        """Counts the deciding penalty at hand, and goes on with the next one; ends a match that is decided."""
        assert self.shootout
        shooter = self.shootout.shooter
        self.shootout.shot(scored)
        if scored:
            self.goal(shooter)
        if self.shootout.decided and self.rules.automatic:
            if not scored:
                self.calls.append(Call(self.state, shooter, reason=Reason.MISSED))
            self.end_half()
        else:
            self.interrupt(self._next_penalty(), None if scored else Reason.MISSED)

    def card(self, robot: str, card: Card) -> None:
        """Shows a card."""
        shown = self.cards.show(robot, card, self.rules)
        self.calls.append(Call(self.state, team_number(robot), robot=robot, card=shown))

    def take_out(self, robot: str, reason: Reason) -> None:
        """Takes a robot off the field without a card."""
        self.cards.take_out(robot, self.rules.repair_s)
        self.calls.append(Call(self.state, team_number(robot), robot=robot, reason=reason))

    def park(self, robots: Iterable[str]) -> None:
        """Takes all robots off the field."""
        for robot in robots:
            self.cards.take_out(robot, self.rules.repair_s)
        self.calls.append(Call(self.state, Team.NONE, reason=Reason.PARK))

    def _begin_stretch(self, sight: Sight | None) -> None:
        excused = misplaced_robots(self.restart, sight, self.ends, self.rules) if sight else []
        ball = sight.ball if sight else self.spot
        keeper = sight.goalkeeper(self.team.other) if sight else ""
        self._stretch = Stretch(self.state, self.team, ball, frozenset(excused), keeper)

    def _next_penalty(self) -> Restart:
        assert self.shootout
        return restarts.penalty(self.shootout.shooter, self.rules, self.ends)

    def _enter(self, state: State, team: Team, stopped: bool) -> None:
        self.state, self.team, self.stopped = state, team, stopped
        self.time_in_state_s = 0.0

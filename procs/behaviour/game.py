"""The referee's state as one team sees it, in the attack frame."""

from enum import Enum
from typing import NamedTuple

from lcmtypes.soccer import game_state_t
from procs.behaviour.view import Frame
from procs.model.field import Point
from procs.model.game_states import State, is_free, state_of
from procs.model.geometry import plausible
from procs.model.teams import Ends, Team


class Whose(Enum):
    """Team of a set piece, seen from the own team."""

    OURS = "ours"
    THEIRS = "theirs"
    NEITHER = "neither team's"


class Game(NamedTuple):
    """State of the game."""

    state: State = State.FROZEN
    stopped: bool = True
    whose: Whose = Whose.NEITHER
    spot: Point = Point(0.0, 0.0)
    """Place of the set piece."""
    sent_off: tuple[str, ...] = ()
    """Robots that take no part in the game."""
    number: int = 0
    """Number of goals, whistles and cards so far."""

    @property
    def free_play(self) -> bool:
        """True if all robots may play the ball."""
        return is_free(self.state, self.stopped)

    @property
    def faces_penalty(self) -> bool:
        """True if the other team has a penalty."""
        return self.state is State.PENALTY and self.whose is Whose.THEIRS

    @property
    def paused(self) -> bool:
        """True if no robot may move."""
        return self.state in (State.FROZEN, State.HALF_TIME)


def frame_of(message: game_state_t, team: Team) -> Frame:
    """Returns the attack frame of a team, which turns when the teams change ends."""
    return Frame(-Ends.told(message.cyan_side).side_of(team))


def game_of(message: game_state_t, team: Team, frame: Frame) -> Game:
    """Converts the referee's message; an unknown state stops the robot."""
    whose = Whose.NEITHER
    if message.state_team in (Team.CYAN, Team.MAGENTA):
        whose = Whose.OURS if message.state_team == team else Whose.THEIRS
    x_m, y_m = message.ball_x_m, message.ball_y_m
    spot = frame.point(x_m, y_m) if plausible(x_m, y_m) else Point(0.0, 0.0)
    return Game(state_of(message.state), message.stopped, whose, spot, tuple(message.sent_off), message.decisions)

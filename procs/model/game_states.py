"""States of the game."""

from enum import IntEnum


class State(IntEnum):
    """States of the game; the numbers are those of the message."""

    FROZEN = 0
    PLAY = 1
    KICK_OFF = 2
    DROP_BALL = 3
    PENALTY = 4
    CORNER_KICK = 5
    THROW_IN = 6
    FREE_KICK = 7
    GOAL_KICK = 8
    HALF_TIME = 9

    @property
    def is_set_piece(self) -> bool:
        """True if the ball is put on a spot, from which a team, or either one, plays it."""
        return self not in (State.FROZEN, State.PLAY, State.HALF_TIME)

    @property
    def words(self) -> str:
        """Name of the state for people, such as `kick-off` or `corner kick`."""
        return _WORDS.get(self, self.name.lower().replace("_", " "))


def is_free(state: State, stopped: bool) -> bool:
    """Returns whether all robots may play the ball."""
    return state is State.PLAY or (state is State.DROP_BALL and not stopped)


def state_of(number: int) -> State:
    """Returns the state with a number from a message; FROZEN, in which no robot moves, for an unknown number."""
    return _STATES.get(number, State.FROZEN)


_STATES = {int(state): state for state in State}
_WORDS = {State.KICK_OFF: "kick-off", State.DROP_BALL: "dropped ball", State.THROW_IN: "throw-in"}

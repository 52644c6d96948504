"""The ball of a set piece, which the crew puts on the spot that the state of the game states."""

import math

import numpy as np

from lcmtypes.soccer import game_state_t
from procs.model.frames import Floats
from procs.model.game_states import is_free, state_of
from procs.model.geometry import plausible
from procs.world_model.ball_tracker import BallTracker


class PlacedBall:
    """Finds out when and where the crew puts the ball down."""

    def __init__(self) -> None:
        self._stopped_s = math.inf  # how long the game had been stopped in the last state; infinite: it was running

    def spot_m(self, game: game_state_t, ball: BallTracker) -> Floats | None:
        """Returns the spot (2), world frame, when a stoppage begins, and while an unknown ball waits there; else None.

        Args:
            game: the newest state of the game.
            ball: the tracker of the ball.
        """
        begins = game.stopped and game.time_in_state_s < self._stopped_s
        self._stopped_s = game.time_in_state_s if game.stopped else math.inf
        state = state_of(game.state)
        waits = state.is_set_piece and not is_free(state, game.stopped)
        if not (waits and (begins or not ball.known) and plausible(game.ball_x_m, game.ball_y_m)):
            return None
        return np.array((game.ball_x_m, game.ball_y_m))

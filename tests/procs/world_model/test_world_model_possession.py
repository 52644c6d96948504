"""The holder of the ball: the robot itself, a mate that says so, or an opponent at the ball."""

import numpy as np
import pytest

from lcmtypes.soccer import robot_estimate_t, world_model_t
from procs.world_model.possession import OPPONENT, holder_of
from procs.world_model.team import Mate

MOUTH_M = 0.3
NOW_S = 10.0


def model_with(opponent_m: float, deviation_m: float = 0.02, known: bool = True) -> world_model_t:
    """Returns a world model with an opponent at a distance from the ball."""
    model = world_model_t()
    model.ball.known = known
    model.ball.covariance = np.diag([deviation_m**2 / 2] * 2 + [1.0, 1.0]).tolist()
    model.opponents = [robot_estimate_t(x_m=opponent_m), robot_estimate_t(x_m=5.0)]
    return model


def mate(told_s: float = NOW_S, holds: bool = True) -> Mate:
    """Returns a mate that said at `told_s` whether it has the ball."""
    return Mate("b", "attacker", told_s, np.zeros(2), 0.0, np.zeros(2), True, np.zeros((2, 2)), holds_ball=holds)


def test_own_barrier_counts_before_all_others() -> None:
    assert holder_of(model_with(0.1), "a", True, [mate()], NOW_S, MOUTH_M) == "a"


def test_mate_holds_the_ball_while_its_word_is_fresh() -> None:
    free = model_with(4.0)
    assert holder_of(free, "a", False, [mate(holds=False), mate()], NOW_S, MOUTH_M) == "b"
    assert holder_of(free, "a", False, [mate(NOW_S - 0.4)], NOW_S, MOUTH_M) == ""


@pytest.mark.parametrize(
    ("opponent_m", "deviation_m", "holder"),
    [(0.3, 0.02, OPPONENT), (0.33, 0.02, OPPONENT), (0.36, 0.02, ""), (0.36, 0.1, OPPONENT), (0.95, 1.0, "")],
)
def test_opponent_has_a_ball_within_its_mouths_reach(opponent_m: float, deviation_m: float, holder: str) -> None:
    assert holder_of(model_with(opponent_m, deviation_m), "a", False, [], NOW_S, MOUTH_M) == holder


@pytest.mark.parametrize(("z_m", "holder"), [(0.1, OPPONENT), (0.6, "")])
def test_ball_that_flies_over_an_opponent_is_not_held(z_m: float, holder: str) -> None:
    model = model_with(0.1)
    model.ball.z_m = z_m
    assert holder_of(model, "a", False, [], NOW_S, MOUTH_M) == holder


def test_unknown_ball_has_no_holder_among_opponents() -> None:
    assert holder_of(model_with(0.0, known=False), "a", False, [], NOW_S, MOUTH_M) == ""

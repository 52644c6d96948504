"""Claims about others, and about a ball that is not seen, are counted as covered or not."""

import numpy as np
import pytest

from lcmtypes.soccer import ground_truth_t, mate_estimate_t, robot_estimate_t, true_robot_t, world_model_t
from procs.evaluation.claims import claims
from procs.evaluation.piece import Piece

TICKS = range(100, 110)


def piece_with(model: world_model_t) -> Piece:
    """Returns a piece in which cyan1 always believes the same; the ball rests in the centre."""
    made = Piece(0.05)
    robots = [true_robot_t(name="cyan1"), true_robot_t(name="cyan2", x_m=2.0), true_robot_t(name="magenta1", x_m=-3.0)]
    made.truth = {tick: ground_truth_t(robots=robots) for tick in TICKS}
    made.by_robot["world_model"] = {"cyan1": dict.fromkeys(TICKS, model)}
    return made


def believing(error_m: float, age_s: float = 0.5) -> world_model_t:
    """Returns beliefs that are all wrong by `error_m`, with a claimed deviation of 0.1 m."""
    spread_m2 = (np.eye(2) * 0.1**2).tolist()
    made = world_model_t()
    made.ball.known, made.ball.x_m, made.ball.age_s = True, error_m, age_s
    made.ball.covariance = (np.eye(4) * 0.1**2).tolist()
    made.mates = [mate_estimate_t(name=name, x_m=2.0 + error_m, covariance_m2=spread_m2) for name in ("cyan2", "gone")]
    ghost = robot_estimate_t(x_m=5.0, covariance_m2=spread_m2)
    made.opponents = [robot_estimate_t(x_m=-3.0 + error_m, covariance_m2=spread_m2), ghost]
    return made


@pytest.mark.parametrize(("error_m", "covered"), [(0.2, 1.0), (0.3, 0.0)])
def test_claims_cover_errors_up_to_their_ellipse(error_m: float, covered: float) -> None:
    found = claims(piece_with(believing(error_m)))
    assert {name: (len(values), values.mean()) for name, values in found.items()} == {
        "inside 95 %, ball unseen": (10, covered),
        "inside 95 %, opponents": (10, covered),
        "inside 95 %, mates": (10, covered),
    }


def test_ball_that_was_just_seen_is_not_unseen() -> None:
    assert len(claims(piece_with(believing(0.1, age_s=0.2)))["inside 95 %, ball unseen"]) == 0


def test_robots_without_a_covariance_claim_nothing() -> None:
    model = believing(0.0)
    model.mates[0].covariance_m2 = model.opponents[0].covariance_m2 = [[0.0, 0.0], [0.0, 0.0]]
    found = claims(piece_with(model))
    assert len(found["inside 95 %, mates"]) == len(found["inside 95 %, opponents"]) == 0

"""A ball drawn from the truth: what errors in the picture do to its place."""

import math

import numpy as np
import pytest

from procs.simulation.ball_sight import BallSight
from procs.simulation.percept_errors import PerceptErrors
from procs.simulation.sight import Glimpse
from procs.vision.mirror import Mirror

MIRROR = Mirror()


@pytest.mark.parametrize("radius_m", [0.11, 0.25])
def test_pixels_count_in_the_plane_of_the_balls_middle(radius_m: float) -> None:
    sight = BallSight(MIRROR, radius_m, 8.0, PerceptErrors(), 0.4, stated_px=0.5)
    percept = sight.found(np.array([(3.0, 0.0)]), 0.0, Glimpse(1.0, 0.0, one_edge=True), (0.5, 0.0), [0.0, 0.0, 0.0])
    middle_px = MIRROR.project(np.array([(3.0, 0.0, radius_m)]))
    shaken_m = MIRROR.ground(middle_px - np.array((0.0, 0.5)), radius_m)[0, 0]
    assert percept.x_m - 3.0 == pytest.approx(shaken_m - 3.0, rel=0.03)
    assert math.sqrt(percept.covariance_m2[0][0]) == pytest.approx(shaken_m - 3.0, rel=0.05)

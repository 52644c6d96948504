"""Stated deviations of percepts are those that the simulated cameras have, however fast the robot drives."""

import math

import pytest

from procs.model.expected_errors import EXPECTED
from procs.model.realism import Realism
from procs.simulation.percept_errors import PRESETS


@pytest.mark.parametrize("realism", ["friendly", "realistic"])
@pytest.mark.parametrize("speed_m_s", [0.0, 0.5, 1.0, 2.0, 3.0])
def test_stated_deviation_of_a_ball_is_the_true_one(realism: Realism, speed_m_s: float) -> None:
    """The mirror of a robot that stands shakes, too, and the finder adds an error of its own."""
    stated, true = EXPECTED[realism], PRESETS[realism]
    stated_px = stated.ball_px * (1.0 + stated.ball_shake_s_m * speed_m_s)
    true_px = math.hypot(true.shake_px + true.shake_px_per_m_s * speed_m_s, true.ball_px)
    assert stated_px == pytest.approx(true_px, rel=0.25)

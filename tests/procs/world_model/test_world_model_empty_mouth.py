"""A ball that the own camera shows in the own mouth while the light barrier sees none there."""

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import ball_percept_t
from procs.model.ball import BALL
from procs.model.robot import ROBOT
from procs.world_model.empty_mouth import EmptyMouth
from procs.world_model.world_model import WorldModel

MOUTH_M = ROBOT.held_ball_m(BALL)
TICK_US = 40_000


def percept(x_m: float) -> ball_percept_t:
    return ball_percept_t(visible=True, x_m=x_m, covariance_m2=(np.eye(2) * 1e-4).tolist())


def mouth_after(*held: bool) -> EmptyMouth:
    """Returns the mouth after readings of the light barrier, one a tick from the time 0 on."""
    mouth = EmptyMouth()
    for tick, ball_held in enumerate(held):
        mouth.note(kicker_state_t(ball_held=ball_held, capture_us=tick * TICK_US))
    return mouth


@pytest.mark.parametrize(("frames", "counts"), [(1, False), (2, True)])
def test_ball_in_the_empty_mouth_needs_two_frames(frames: int, counts: bool) -> None:
    bench = Bench(WorldModel, "cyan1/world_model", period_s=0.04)
    for tick in range(10):
        bench.port("pose").put(covariance=(np.eye(3) * 1e-5).tolist(), localized=True)
        bench.port("kicker_state").put(capture_us=bench.time_us + TICK_US)
        shown = percept(MOUTH_M) if 5 <= tick < 5 + frames else ball_percept_t()
        bench.port("ball_percept").put(shown, capture_us=bench.time_us + 5_000)
        bench.iterate()
    believed, told = bench.port("world_model").sent[-1], bench.port("team_message").sent
    assert believed.ball.known is counts
    assert any(message.ball_visible for message in told) is counts


@pytest.mark.parametrize(
    ("held", "exposed_us", "x_m", "refuted"),
    [
        pytest.param((False, False), 35_000, MOUTH_M, True, id="empty before and after"),
        pytest.param((False, False), 35_000, MOUTH_M + 0.1, False, id="in front of the mouth"),
        pytest.param((True, False), 35_000, MOUTH_M, False, id="kicked after the exposure"),
        pytest.param((False, True), 35_000, MOUTH_M, False, id="caught after the exposure"),
        pytest.param((False, False), 75_000, MOUTH_M, False, id="not read since the exposure"),
        pytest.param((), 35_000, MOUTH_M, False, id="no light barrier"),
    ],
)
def test_light_barrier_refutes_what_it_would_have_seen(
    held: tuple[bool, ...], exposed_us: int, x_m: float, refuted: bool
) -> None:
    assert mouth_after(*held).refutes(percept(x_m), exposed_us, MOUTH_M) is refuted


def test_single_frames_in_the_empty_mouth_never_count() -> None:
    mouth = mouth_after(False, False)
    shown_m = (MOUTH_M, 3.0, MOUTH_M, MOUTH_M, MOUTH_M, 3.0, MOUTH_M)
    found = [mouth.refutes(percept(x_m), 35_000, MOUTH_M) for x_m in shown_m]
    assert found == [True, False, True, False, False, False, True]

"""A lob that meets the bar of a goal comes back; one that passes under, over or beside it does not."""

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.model.field import Field
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import NO_CONTACT, Contact
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.crossbar import Crossbars
from procs.world_model.flight import Flight
from procs.world_model.walls import Walls

STEP_S = 0.04
LINE_M = Field().goal_plane_m


def ball(x_m: float, y_m: float, vx_m_s: float) -> BallFilter:
    """Returns a ball whose place is known well, and that was kicked along x just now."""
    found = BallFilter(np.array((x_m, y_m)), np.eye(2) * 0.01**2, BALL)
    found.kick(np.array((vx_m_s, 0.0)), np.array((x_m, y_m)), np.eye(2) * 0.01**2)
    return found


def met(x_m: float, y_m: float, vx_m_s: float, height_m: float, lift_m_s: float = 0.0) -> Contact:
    """Returns what the bars do in a step at whose beginning the ball is at that place and height, known well."""
    flight = Flight(height_m, lift_m_s, 0.02**2, 0.0, 0.1**2)
    return Crossbars.of(Field(), BALL).contact(ball(x_m, y_m, vx_m_s), flight, STEP_S)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(
    ("height_m", "lift_m_s", "y_m", "hit"),
    [
        pytest.param(0.95, 0.0, 0.5, True, id="bar"),
        pytest.param(0.70, 0.0, 0.5, False, id="under it"),
        pytest.param(1.20, 0.0, 0.5, False, id="over it"),
        pytest.param(0.70, 5.0, 0.5, True, id="rises to it"),
        pytest.param(0.95, 0.0, 1.6, False, id="beside the goal"),
    ],
)
def test_ball_as_high_as_the_bar_meets_it(side: float, height_m: float, lift_m_s: float, y_m: float, hit: bool) -> None:
    contact = met(side * (LINE_M - 0.3), y_m, side * 10.0, height_m, lift_m_s)
    assert contact.hit > 0.9 if hit else contact.hit < 0.1
    if hit:
        assert contact.change_x_m_s == pytest.approx(-side * 17.0, rel=0.02)
        assert contact.after_s == pytest.approx(0.03, abs=1e-3)


@pytest.mark.parametrize(
    ("x_m", "vx_m_s"),
    [
        pytest.param(LINE_M - 1.0, 10.0, id="not yet there"),
        pytest.param(LINE_M + 0.1, 10.0, id="behind it"),
        pytest.param(LINE_M - 0.2, -10.0, id="comes from it"),
        pytest.param(LINE_M - 0.2, 0.0, id="rests"),
    ],
)
def test_ball_that_does_not_cross_the_line_meets_no_bar(x_m: float, vx_m_s: float) -> None:
    assert met(x_m, 0.0, vx_m_s, 0.95) == NO_CONTACT


@pytest.mark.parametrize(("lift_m_s", "comes_back"), [(5.7, True), (3.0, False)])
def test_lob_at_the_bar_is_believed_to_come_back(lift_m_s: float, comes_back: bool) -> None:
    """Its kicker believed a lob in the net that the bar had sent back, until a robot saw the ball."""
    tracker, walls = BallTracker(), Walls.of(Field(), BALL)
    tracker.advance(STEP_S, 2.0)
    tracker.hold("a", np.array((9.0, 0.3, 0.0, 0.0)), np.eye(4) * 1e-4)
    tracker.kick(np.array((9.5, 0.0)), lift_m_s=lift_m_s)
    for _ in range(8):
        tracker.advance(STEP_S, 2.0, walls=walls)
    x_m, _, vx_m_s, _ = tracker.track.state
    if comes_back:
        assert x_m < LINE_M - 0.3
        assert vx_m_s < -4.0
    else:
        assert x_m > LINE_M

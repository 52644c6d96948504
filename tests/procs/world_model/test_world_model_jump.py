"""A track that jumps to a single sighting, which may show another thing: the next sighting decides."""

import numpy as np
import pytest

from procs.world_model.ball_tracker import BallTracker
from procs.world_model.sighting import Sighting
from tests.procs.world_model.eyes import PERIOD_S, Floats

SPEED_M_S = 5.0
ASIDE_M = np.array((-0.1, 0.35))
FAR_ASIDE_M = np.array((-1.75, 3.0))
ACROSS_M_S = np.array((0.0, 5.0))


def sighting(robot: str, place_m: Floats) -> Sighting:
    return Sighting(robot, robot == "me", place_m, np.eye(2) * 0.02**2)


def place_in(frame: int) -> Floats:
    """Returns where a ball is that rolls along x."""
    return np.array((SPEED_M_S * PERIOD_S * frame, 0.0))


def jumped(seen_until: int = 11, aside_m: Floats = ASIDE_M) -> BallTracker:
    """Returns a track that jumps in frame 11 of the own camera; a mate saw the ball roll beside robots before."""
    tracker = BallTracker()
    for frame in range(12):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        if frame < seen_until:
            tracker.see(sighting("mate", place_in(frame)))
    tracker.see(sighting("me", place_in(11) + aside_m))
    assert tracker.track.state[:2] == pytest.approx(place_in(11) + aside_m, abs=0.05)
    return tracker


@pytest.mark.parametrize(("seen_until", "aside_m"), [(11, ASIDE_M), (6, FAR_ASIDE_M)])
@pytest.mark.parametrize("frame", [11, 12])
def test_ball_goes_on_as_before_a_phantom(frame: int, seen_until: int, aside_m: Floats) -> None:
    """A mate sees the ball at the same exposure or in the next frame; the ball was in sight before, or was not."""
    tracker = jumped(seen_until, aside_m)
    if frame > 11:
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
    tracker.see(sighting("mate", place_in(frame)))
    assert tracker.track.state == pytest.approx((*place_in(frame), SPEED_M_S, 0.0), abs=0.5)


def test_struck_ball_stays_where_two_frames_show_it() -> None:
    tracker, place_m = jumped(), place_in(11) + ASIDE_M
    for frame in (12, 13):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        place_m = place_m + PERIOD_S * ACROSS_M_S
        tracker.see(sighting("me", place_m))
        tracker.see(sighting("another", place_in(frame)))  # it errs about its own place
    assert tracker.track.state[:2] == pytest.approx(place_m, abs=0.05)


def test_ball_that_was_struck_after_all_is_found() -> None:
    """A wrong sighting takes the track back once; the ones before and after it fit each other."""
    tracker, place_m = jumped(), place_in(11) + ASIDE_M
    tracker.see(sighting("mate", place_in(11)))
    for _ in range(2):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        place_m = place_m + PERIOD_S * ACROSS_M_S
        tracker.see(sighting("me", place_m))
    assert tracker.track.state == pytest.approx((*place_m, *ACROSS_M_S), abs=1.0)

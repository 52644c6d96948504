"""The ball tracker when the ball is kicked, hit or bounces: velocity, sliding, old sightings."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.simulation.physics.rolling import RollingFriction
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.contact import Robots
from procs.world_model.seen import Seen
from procs.world_model.sighting import Sighting
from tests.procs.world_model.eyes import PERIOD_S, Eye, Floats, rms, rolling


def test_kicked_ball_has_the_right_velocity_after_150_ms() -> None:
    speeds = []
    for seed in range(30):
        eye = Eye("a", (0, 0), seed, recognised=1.0)
        tracker = BallTracker()
        for state in [*rolling((1, 0.5), (0, 0), 20), *rolling((1, 0.5), (8, 0), 3)]:
            tracker.advance(PERIOD_S, 2.0)
            sighting = eye.look(state[:2], own=True)
            assert sighting is not None
            tracker.see(sighting)
        speeds.append(tracker.track.state[2:] - state[2:])
    assert np.median(np.hypot(*np.array(speeds).T)) < 0.8, "10 % of 8 m/s"


def hit(velocity_m_s: tuple[float, float], rest: int, frames: int) -> Iterator[Floats]:
    """Returns true states (4) of a ball that rests, then is hit, slides and at last rolls, as in the simulation."""
    friction, position = RollingFriction(BALL), np.zeros(2)
    velocity = (0.0, 0.0)
    for frame in range(frames):
        velocity = friction.advance(*(velocity_m_s if frame == rest else velocity), PERIOD_S)
        position = position + np.array(velocity) * PERIOD_S
        yield np.concatenate((position, velocity))


def follow_hit(
    velocity_m_s: tuple[float, float],
    frames: int,
    places: Sequence[tuple[float, float]],
    contact_until: int,
    counts_after: int,
    told_m_s: tuple[float, float] | None = None,
) -> tuple[float, float]:
    """Follows a ball that is hit in frame 20, six times, with robots at `places` that see it by turns.

    Returns:
        Error of the velocity in m/s after frame `counts_after`, and the mean slip from settling in m/s.
    """
    errors, slips = [], []
    for seed in range(6):
        eyes = [Eye(f"r{i}", at, 10 * seed + i) for i, at in enumerate(places)]
        tracker = BallTracker()
        for frame, state in enumerate(hit(velocity_m_s, 20, frames)):
            if told_m_s and frame == 20:
                tracker.kick(np.array(told_m_s))
            tracker.advance(PERIOD_S, 2.0, contact=frame <= contact_until)
            for number, eye in enumerate(eyes):
                sighting = eye.look(state[:2], own=number == 0) if (frame + number) % 2 else None
                if sighting is not None:
                    tracker.see(sighting)
            if frame > counts_after:
                errors.append(tracker.track.state - state)
                slips.append(np.hypot(*(tracker.track.state[2:] - tracker.track.settled_m_s)))
    return rms(np.array(errors)[:, 2:]), float(np.mean(slips))


def test_ball_that_an_opponent_hit_is_known_to_slide() -> None:
    """Nothing announces the kick; the time since a robot was near tells until when the ball slides."""
    error_m_s, slip_m_s = follow_hit((9.0, 2.7), 40, [(-2.0, 1.0), (2.0, -2.0), (1.0, 3.0)], 20, 26)
    assert error_m_s < 0.2
    assert slip_m_s > 1.0


def test_kicked_ball_slides_although_the_kicker_is_near() -> None:
    """For two ticks the kicker might touch the ball again; the known speed still tells that the ball slides."""
    error_m_s, slip_m_s = follow_hit((3.8, 0.8), 32, [(-2.0, 1.0), (2.0, -2.0)], 22, 25, told_m_s=(3.7, 0.7))
    assert slip_m_s > 0.15
    assert error_m_s < 0.2


def test_free_ball_that_is_not_seen_is_hardly_expected_to_be_hit() -> None:
    tracker, eye = BallTracker(), Eye("a", (0, 0), 3, recognised=1.0)
    for frame, state in enumerate(rolling((-2.0, 1.0), (1.5, 0.3), 66)):
        tracker.advance(PERIOD_S, 2.0)
        sighting = eye.look(state[:2], own=True)
        if sighting is not None and frame < 60:
            tracker.see(sighting)
    claimed_m_s = math.sqrt(np.trace(tracker.track.covariance[2:, 2:]))
    assert np.hypot(*(tracker.track.state - state)[2:]) < 2 * claimed_m_s < 0.9


def just_kicked(robot: str, held: int) -> BallTracker:
    """Returns the tracker of a robot that held the ball so many frames and kicked it at 8 m/s a frame ago."""
    tracker = BallTracker()
    for _ in range(held):
        tracker.advance(PERIOD_S, 2.0)
        tracker.hold(robot, np.array((0.33, 0.0, 0.0, 0.0)), np.zeros((4, 4)))
    tracker.kick(np.array((8.0, 0.0)))
    tracker.advance(PERIOD_S, 2.0)
    return tracker


def test_own_kick_is_believed_before_any_sighting() -> None:
    tracker = just_kicked("a", held=10)
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.1)
    tracker.see(Sighting("a", True, np.array((0.73, 0.0)), np.eye(2) * 0.02**2))
    assert tracker.age_s == 0.0, "the sighting fits"
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.25)


def test_late_sighting_from_before_a_kick_does_not_undo_it() -> None:
    """An opponent kicks a resting ball; the own camera sees it fly, a mate's sightings come 0.15 s late."""
    tracker = BallTracker()
    places_m = [max(0.0, 7.0 * (frame - 12) * PERIOD_S) for frame in range(20)]
    for frame, x_m in enumerate(places_m):
        tracker.advance(PERIOD_S, 2.0, contact=True)
        tracker.see(Sighting("me", True, np.array((x_m, 0.0)), np.eye(2) * 0.02**2))
        if frame >= 3:
            late_m = np.array((places_m[frame - 3], 0.0))
            tracker.see(Sighting("mate", False, late_m, np.eye(2) * 0.02**2, age_s=3 * PERIOD_S))
        if frame >= 14:
            assert tracker.track.state[:2] == pytest.approx((x_m, 0.0), abs=0.06)
            assert tracker.track.state[2:] == pytest.approx((7.0, 0.0), abs=0.9)


def test_cameras_outrank_the_kickers_old_sighting() -> None:
    """A mate saw the ball sharply, then kicked it; the robot's own camera gives a frame every second tick."""
    tracker = BallTracker()
    for _ in range(6):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("kicker", False, np.array((1.0, 0.0)), np.eye(2) * 0.005**2))
    for frame in range(1, 5):
        tracker.advance(PERIOD_S, 2.0)
        ball_m = np.array((1.0 + 8.0 * frame * PERIOD_S, 0.0))
        if frame % 2 == 0:
            tracker.see(Sighting("me", True, ball_m, np.eye(2) * 0.06**2))
    assert np.hypot(*(tracker.track.state[:2] - ball_m)) < 0.1
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.1)


def test_ball_that_bounces_off_a_robot_is_followed_at_once() -> None:
    """After 0.15 s the error of the velocity is a tenth of the change."""
    errors = []
    for seed in range(20):
        eye, tracker = Eye("a", (0, 0), seed, recognised=1.0), BallTracker()
        for frame, state in enumerate([*rolling((-2, 1), (4.0, 0), 12), *rolling((0.3, 1), (-2.0, 1.0), 3)]):
            tracker.advance(PERIOD_S, 2.0, contact=frame >= 10)
            sighting = eye.look(state[:2], own=True)
            assert sighting is not None
            tracker.see(sighting)
        errors.append(np.hypot(*(tracker.track.state[2:] - state[2:])))
    assert np.median(errors) < 0.6


def test_sighting_from_before_a_kick_tells_nothing() -> None:
    """A mate's camera was exposed before the robot's own kick; its message arrives after the kick."""
    tracker = just_kicked("me", held=4)
    tracker.see(Sighting("mate", False, np.array((0.33, 0.0)), np.eye(2) * 0.01**2, age_s=0.1))
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.03)


def test_kick_of_a_mate_begins_at_its_mouth() -> None:
    """Cameras have already shown a part of the flight, which must not count twice."""
    tracker = BallTracker()
    for frame in range(8):
        tracker.advance(PERIOD_S, 2.0, contact=True)
        flight_s = max(0, frame - 5) * PERIOD_S
        ball_m = np.array((8.0 * flight_s - BALL.sliding_m_s2 / 2 * flight_s**2, 0.0))
        tracker.see(Sighting("me", True, ball_m, np.eye(2) * 0.05**2))
    mouth = Seen.of([(0.0, 0.0)], [np.eye(2) * 0.03**2], [0.0])
    tracker.kick(np.array((8.0, 0.0)), 0.1, mouth)
    assert tracker.track.state[0] == pytest.approx(0.8, abs=0.03)
    assert tracker.track.state[2] == pytest.approx(7.7, abs=0.1)


def test_frame_between_command_and_kick_does_not_slow_the_ball() -> None:
    """The ball leaves in the middle of a tick; a frame from the first half of it still shows the ball in the mouth."""
    tracker = BallTracker()
    for _ in range(10):
        tracker.advance(0.04, 2.0, contact=True)
        tracker.hold("me", np.array((0.33, 0.0, 0.0, 0.0)), np.eye(4) * 1e-4)
    tracker.kick(np.array((8.0, 0.0)), -0.02)
    flown_s = -0.02
    for tick in range(5):
        tracker.advance(0.04, 2.0)
        flown_s += 0.04
        if tick % 2 == 0:
            x_m = 0.33 + 8.0 * max(0.0, flown_s - 0.035) - 1.5 * max(0.0, flown_s - 0.035) ** 2
            tracker.see(Sighting("me", True, np.array((x_m, 0.0)), np.eye(2) * 0.02**2, age_s=0.035))
        assert tracker.track.state[2] == pytest.approx(8.0 - 3.0 * flown_s, rel=0.05)


def test_kick_ends_the_touches_that_were_possible() -> None:
    """A mate hears of a kick a tick later; that tick began with the kicker at the ball."""
    tracker = just_kicked("a", held=10)
    late = just_kicked("a", held=10)
    tracker.advance(0.05, 2.0)
    late.advance(0.05, 2.0, robots=Robots(((0.0, 0.0, 0.0, 0.0, 0.03**2),), touch_m=0.33, height_m=0.8))
    late.kick(np.array((8.0, 0.0)), 0.05)
    assert late.track.covariance[2, 2] < 2 * tracker.track.covariance[2, 2]


def moved_to(place_m: tuple[float, float], height_m: float = 0.0) -> BallTracker:
    """Returns the track of a resting ball that two robots see at another place in their next frames, at one time."""
    tracker = BallTracker()
    for _ in range(10):
        tracker.advance(0.04, 2.0)
        tracker.see(Sighting("a", True, np.zeros(2), np.eye(2) * 0.02**2))
    tracker.advance(0.04, 2.0)
    for robot in ("a", "b"):
        tracker.see(Sighting(robot, robot == "a", np.array(place_m), np.eye(2) * 0.02**2, height_m=height_m))
    return tracker


def test_kick_that_two_robots_see_at_once_has_a_velocity() -> None:
    """Sightings of one moment tell none, but the ball came from where it was seen last."""
    assert moved_to((0.42, 0.0)).track.state[2:] == pytest.approx((10.0, 0.0), abs=1.5)
    lob = moved_to((0.42, 0.0), height_m=0.3)
    assert lob.flight is not None
    assert lob.flight.lift_m_s > 2.0


def test_ball_that_was_put_elsewhere_has_no_velocity() -> None:
    assert moved_to((2.0, 1.0)).track.state == pytest.approx((2.0, 1.0, 0.0, 0.0), abs=0.05)

"""The ball tracker on synthetic sightings: resting, rolling, held, seen by many; consistency and precedence."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import Contact
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.sighting import Sighting
from tests.procs.world_model.eyes import PERIOD_S, ROLLING_M_S2, ROLLING_NOISE_M2_S3, Eye, Floats, follow, rms, rolling


def test_resting_ball_is_known_to_5_cm_and_10_cm_per_second() -> None:
    errors = np.concatenate([follow([Eye("a", (0, 0), seed)], rolling((4, 0), (0, 0), 100))[30:] for seed in range(10)])
    assert rms(errors[:, :2]) < 0.05
    assert rms(errors[:, 2:]) < 0.10


def test_rolling_ball_is_known_to_10_cm_and_30_cm_per_second() -> None:
    errors = np.concatenate(
        [follow([Eye("a", (0, 0), seed)], rolling((-3.5, 1), (2.5, 0.3), 50))[10:] for seed in range(20)]
    )
    assert rms(errors[:, :2]) < 0.10
    assert rms(errors[:, 2:]) < 0.30


@pytest.mark.slow
def test_fused_ball_beats_the_best_single_robot() -> None:
    places = [(-2.0, 0.5), (3.0, -2.0), (-4.0, 4.0), (5.0, 4.0)]

    def eyes(seed: int) -> list[Eye]:
        return [Eye(f"r{number}", place, 100 * seed + number) for number, place in enumerate(places)]

    def course() -> Iterator[Floats]:
        return rolling((-1.0, 2.0), (1.0, -0.5), 60)

    fused = rms(np.concatenate([follow(eyes(seed), course())[15:, :2] for seed in range(10)]))
    single = [
        rms(np.concatenate([follow([eyes(seed)[number]], course())[15:, :2] for seed in range(10)]))
        for number in range(4)
    ]
    assert fused <= min(single)
    assert fused <= 0.5 * np.median(single)
    averages = []
    for seed in range(10):
        watchers = eyes(seed)
        for state in course():
            seen = [one.position_m for eye in watchers if (one := eye.look(state[:2]))]
            averages.append(np.mean(seen, axis=0) - state[:2])
    assert fused <= 0.8 * rms(np.array(averages)), "a plain average of all sightings"


def nees(eyes_at: list[tuple[float, float]], runs: int, frames: int = 30) -> float:
    """Returns the mean normalised squared error at the end of runs whose truth follows the filter's motion model."""
    values = []
    for seed in range(runs):
        rng = np.random.default_rng(1000 + seed)
        eyes = [Eye(f"r{number}", place, 7 * seed + number) for number, place in enumerate(eyes_at)]
        tracker = BallTracker()
        state = np.array((*rng.uniform(-1, 1, 2), *rng.uniform(-3.0, 3.0, 2)))
        for _ in range(frames):
            speed = float(np.hypot(*state[2:]))
            push = math.sqrt(ROLLING_NOISE_M2_S3 / PERIOD_S) * rng.standard_normal(2)
            slower = state[2:] * max(0.0, 1 - ROLLING_M_S2 * PERIOD_S / speed)
            state[:2] += (state[2:] + slower) / 2 * PERIOD_S + push * PERIOD_S**2 / 2
            state[2:] = slower + push * PERIOD_S
            tracker.advance(PERIOD_S, 2.0)
            for number, eye in enumerate(eyes):
                if (sighting := eye.look(state[:2], own=number == 0)) is not None:
                    tracker.see(sighting)
        error = tracker.track.state - state
        values.append(float(error @ np.linalg.solve(tracker.track.covariance, error)))
    return float(np.mean(values))


@pytest.mark.slow
@pytest.mark.parametrize("eyes_at", [[(-2.0, 0.0)], [(-2.0, 0.0), (3.0, 2.0), (0.0, -4.0)]])
def test_covariance_is_honest(eyes_at: list[tuple[float, float]]) -> None:
    runs = 60
    deviation = math.sqrt(2 * 4 / runs)
    assert 4 - 3 * deviation < nees(eyes_at, runs) < 4 + 3 * deviation


def test_phantom_seen_once_changes_nothing() -> None:
    tracker = BallTracker()
    for frame in range(20):
        tracker.advance(PERIOD_S, 2.0)
        place = (5.0, 5.0) if frame == 15 else (1.0, 1.0)
        tracker.see(Sighting("a", True, np.array(place), np.eye(2) * 0.02**2))
        assert (tracker.age_s == 0.0) == (frame != 15)
    assert tracker.track.state[:2] == pytest.approx((1.0, 1.0), abs=0.02)


def test_less_likely_candidate_that_fits_is_the_ball() -> None:
    """Something orange seems more like a ball than the ball, which robots hide in part."""
    tracker = BallTracker()
    here_m, there_m = np.array((1.0, 0.0)), np.array((-3.0, 2.0))
    for _ in range(20):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("a", True, here_m, np.eye(2) * 0.02**2))
    for _ in range(20):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(*(Sighting("a", True, place_m, np.eye(2) * 0.02**2) for place_m in (there_m, here_m)))
        assert tracker.track.state[:2] == pytest.approx(here_m, abs=0.03)
        assert tracker.age_s == 0.0


def test_moved_ball_is_found_with_the_second_sighting() -> None:
    tracker = BallTracker()
    for frame in range(12):
        tracker.advance(PERIOD_S, 2.0)
        place = (1.0, 1.0) if frame < 10 else (-3.0, 0.0)
        tracker.see(Sighting("a", True, np.array(place), np.eye(2) * 0.02**2))
    assert tracker.track.state[:2] == pytest.approx((-3.0, 0.0), abs=0.05)


@pytest.mark.parametrize(("contact", "runs_on", "found"), [(1.0, False, True), (1.0, True, False), (0.0, False, False)])
def test_moving_ball_that_met_something_is_found_at_once(contact: float, runs_on: bool, found: bool) -> None:
    """A ball of 5 m/s is turned aside; one sighting tells, unless a mate sees the ball run on or nothing was near."""
    tracker, place_m = BallTracker(), np.zeros(2)
    for frame in range(12):
        tracker.advance(PERIOD_S, 2.0, contact=contact)
        place_m = np.array((5.0 * PERIOD_S * frame, 0.0))
        if frame < 11 or runs_on:
            tracker.see(Sighting("mate", False, place_m, np.eye(2) * 0.03**2))
    aside_m = place_m + np.array((-0.1, 0.35))
    tracker.see(Sighting("other", False, aside_m, np.eye(2) * 0.02**2))
    assert tracker.track.state[:2] == pytest.approx(aside_m if found else place_m, abs=0.05)
    if found:
        assert tracker.track.state[3] > 2.0


def test_resting_ball_does_not_jump_to_one_sighting() -> None:
    """A mate errs about its place, and sees a resting ball elsewhere."""
    tracker = BallTracker()
    for _ in range(12):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("me", True, np.zeros(2), np.eye(2) * 0.02**2))
    tracker.advance(PERIOD_S, 2.0)
    tracker.see(Sighting("mate", False, np.array((0.5, 0.0)), np.eye(2) * 0.02**2))
    assert tracker.track.state == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=0.05)


def out_of_sight(contact: float, unseen: int = 10, touched_unseen: bool = True) -> BallTracker:
    """Returns a ball that rolled away at 4 m/s, and that no robot has seen for `unseen` ticks."""
    tracker = BallTracker()
    for frame in range(12 + unseen):
        tracker.advance(PERIOD_S, 2.0, contact=contact if frame < 12 or touched_unseen else 0.0)
        if frame < 12:
            place_m = np.array((4.0 * PERIOD_S * frame, 0.0))
            tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.02**2))
    return tracker


@pytest.mark.parametrize(("contact", "y_m", "found"), [(0.0, 4.0, False), (1.0, 4.0, True), (1.0, 40.0, False)])
def test_unseen_ball_jumps_only_if_it_can_have(contact: float, y_m: float, found: bool) -> None:
    """Nothing was near a ball that rolls out of sight, and none is as fast as a thing 40 m away would have to be."""
    tracker, phantom_m = out_of_sight(contact), np.array((1.0, y_m))
    expected_m = phantom_m if found else tracker.track.state[:2]
    tracker.see(Sighting("b", False, phantom_m, np.eye(2) * 0.1**2))
    assert tracker.track.state[:2] == pytest.approx(expected_m, abs=0.01)


def test_unseen_ball_does_not_jump_as_it_was_touched_when_seen() -> None:
    """A contact while robots saw the ball explains no other place once they do not see it."""
    tracker = out_of_sight(1.0, unseen=6, touched_unseen=False)
    expected_m = tracker.track.state[:2]
    tracker.see(Sighting("b", False, np.array((1.0, 3.0)), np.eye(2) * 0.1**2))
    assert tracker.track.state[:2] == pytest.approx(expected_m, abs=0.01)


def test_unseen_ball_is_found_elsewhere_with_two_sightings() -> None:
    tracker = out_of_sight(contact=0.0)
    for _ in range(2):
        tracker.see(Sighting("b", False, np.array((1.0, 4.0)), np.eye(2) * 0.1**2))
        tracker.advance(PERIOD_S, 2.0)
    assert tracker.track.state[:2] == pytest.approx((1.0, 4.0), abs=0.2)


def test_own_sighting_precedes_an_equally_accurate_mate() -> None:
    tracker = BallTracker()
    own, other = np.array((1.0, 1.0)), np.array((2.5, 1.0))
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("me", True, own, np.eye(2) * 0.03**2))
        tracker.see(Sighting("mate", False, other, np.eye(2) * 0.03**2))
        assert tracker.track.state[:2] == pytest.approx(own, abs=0.02)
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("mate", False, other, np.eye(2) * 0.03**2))
    assert tracker.track.state[:2] == pytest.approx(other, abs=0.1)


def test_old_sighting_is_used_for_its_own_time() -> None:
    history = list(rolling((-4.0, 0.0), (3.0, 0.0), 60))
    errors = []
    for seed in range(10):
        eye = Eye("mate", (0.0, -2.0), seed, recognised=1.0)
        tracker = BallTracker()
        for now, then in zip(history[3:], history, strict=False):
            tracker.advance(PERIOD_S, 2.0)
            sighting = eye.look(then[:2], age_s=3 * PERIOD_S)
            assert sighting is not None
            tracker.see(sighting)
            errors.append(tracker.track.state[0] - now[0])
    assert abs(np.mean(errors)) < 0.05, "0.4 m behind without the age"


def test_order_of_arrival_does_not_matter() -> None:
    def state(late: bool) -> Floats:
        tracker, rng = BallTracker(), np.random.default_rng(3)
        held: list[Sighting] = []
        for frame in range(16):
            tracker.advance(PERIOD_S, 2.0)
            noise_m = 0.02 * rng.standard_normal((2, 2))
            tracker.see(Sighting("me", True, np.array((0.1 * frame, 0.0)) + noise_m[0], np.eye(2) * 0.02**2))
            held = [Sighting(one.robot, False, one.position_m, one.covariance_m2, one.age_s + PERIOD_S) for one in held]
            held.append(Sighting("mate", False, np.array((0.1 * frame, 0.0)) + noise_m[1], np.eye(2) * 0.03**2))
            if not late or frame % 4 == 3:
                for one in held:
                    tracker.see(one)
                held = []
        return tracker.track.state

    assert state(late=True) == pytest.approx(state(late=False), abs=1e-9)


def test_ball_is_forgotten_after_the_timeout() -> None:
    tracker = BallTracker()
    tracker.advance(PERIOD_S, 2.0)
    tracker.see(Sighting("a", True, np.zeros(2), np.eye(2) * 0.01))
    for _ in range(39):
        tracker.advance(PERIOD_S, 2.0)
    assert tracker.known
    assert tracker.age_s == pytest.approx(1.95)
    assert tracker.observers == 0
    for _ in range(3):
        tracker.advance(PERIOD_S, 2.0)
    assert not tracker.known


def test_held_ball_is_in_the_mouth_whatever_the_cameras_say() -> None:
    tracker = BallTracker()
    for frame in range(5):
        tracker.advance(PERIOD_S, 2.0)
        tracker.hold("me", np.array((0.33 + frame * PERIOD_S, 0.0, 1.0, 0.0)), np.zeros((4, 4)))
        tracker.see(Sighting("mate", False, np.array((3.0, 3.0)), np.eye(2) * 0.01**2))
        assert tracker.track.state == pytest.approx((0.33 + frame * PERIOD_S, 0.0, 1.0, 0.0), abs=0.06)


def test_older_second_sighting_gives_place_and_velocity() -> None:
    tracker = BallTracker()
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("me", True, np.array((0.0, 0.0)), np.eye(2) * 0.02**2))
    tracker.advance(PERIOD_S, 2.0)
    tracker.see(Sighting("me", True, np.array((2.0, 0.0)), np.eye(2) * 0.02**2))
    tracker.see(Sighting("mate", False, np.array((1.8, 0.0)), np.eye(2) * 0.02**2, age_s=0.04))
    assert tracker.track.state[0] == pytest.approx(2.0, abs=0.05)
    assert tracker.track.state[2] == pytest.approx(5.0, abs=1.0)


def test_held_ball_is_as_uncertain_as_the_own_pose() -> None:
    tracker = BallTracker()
    covariance = np.diag((0.1**2, 0.2**2, 0.0, 0.0))
    for _ in range(3):
        tracker.advance(PERIOD_S, 2.0)
        tracker.hold("me", np.array((0.33, 0.0, 0.0, 0.0)), covariance)  # the pose's error persists from tick to tick
    assert np.sqrt(np.diag(tracker.track.covariance)[:2]) == pytest.approx((0.1, 0.2), rel=0.05)


def inside_95(states: list[Floats], contacts: list[bool], runs: int = 12) -> float:
    """Returns the share of ticks in which the true position lies in the filter's 95 % ellipse."""
    inside = []
    for seed in range(runs):
        eyes = [Eye(f"r{number}", place, 31 * seed + number) for number, place in enumerate([(-2.0, 1.0), (3.0, -3.0)])]
        tracker = BallTracker()
        for frame, (state, contact) in enumerate(zip(states, contacts, strict=True)):
            tracker.advance(PERIOD_S, 2.0, contact=contact)
            for number, eye in enumerate(eyes):
                if frame % 2 == number and (sighting := eye.look(state[:2], own=number == 0)) is not None:
                    tracker.see(sighting)
            if frame > 5:
                error = tracker.track.state[:2] - state[:2]
                inside.append(error @ np.linalg.solve(tracker.track.covariance[:2, :2], error) < 5.991)
    return float(np.mean(inside))


def carried(frames: int) -> list[Floats]:
    """Returns true states (4) of a ball in the mouth of a robot that drives a circle of 1 m radius at 2 m/s."""
    angles = np.arange(frames) * PERIOD_S * 2.0
    return [np.array((np.cos(a), np.sin(a), -2.0 * np.sin(a), 2.0 * np.cos(a))) for a in angles]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("states", "contact"),
    [
        pytest.param(list(rolling((0, 0), (0, 0), 60)), False, id="rests"),
        pytest.param(list(rolling((-2, 0), (2.0, 0.5), 60)), False, id="rolls"),
        pytest.param(carried(60), True, id="is carried"),
        pytest.param(
            [*rolling((0, 0), (0, 0), 30), *rolling((0, 0), (7.0, 2.0), 15)], True, id="is kicked by an opponent"
        ),
    ],
)
def test_claim_is_honest_in_every_case(states: list[Floats], contact: bool) -> None:
    assert inside_95(states, [contact] * len(states)) >= 0.9


def test_held_ball_stays_known_between_two_frames() -> None:
    """A robot at the ball may kick it at any time, but mostly does not."""
    tracker, eye = BallTracker(), Eye("a", (-2.0, 0.0), 1, recognised=1.0)
    for state in carried(20):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        sighting = eye.look(state[:2], own=True)
        assert sighting is not None
        tracker.see(sighting)
    for _ in range(2):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
    assert np.sqrt(np.diag(tracker.track.covariance)[:2]).max() < 0.13


def test_ball_stays_within_the_walls() -> None:
    track = BallFilter(np.array((11.5, 0.0)), np.eye(2) * 0.01**2, BALL)
    track.kick(np.array((8.0, 1.0)))
    for _ in range(20):
        track.predict(PERIOD_S, ROLLING_M_S2)
        track.stay_within(11.89, 7.89, 0.5)
        assert track.state[0] <= 11.89
    assert track.state[2] < 0.0, "it comes back"


def test_covariance_stays_symmetric_and_positive() -> None:
    rng = np.random.default_rng(1)
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01, BALL)
    for _ in range(400):
        track.predict(PERIOD_S, ROLLING_M_S2, Contact(probability=1.0))
        track.see(rng.standard_normal(2) * 0.1, np.diag(rng.uniform(1e-6, 0.1, 2)))
        assert (np.linalg.eigvalsh(track.covariance) > 0).all()
        assert track.covariance == pytest.approx(track.covariance.T, abs=1e-12)


def test_long_step_is_as_sound_as_many_short_ones() -> None:
    """A step may be as long as the age of a message; no probability becomes negative."""
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01, BALL)
    for _ in range(10):
        track.predict(0.5, ROLLING_M_S2, Contact(probability=1.0))
        track.see(np.zeros(2), np.eye(2) * 0.01)
    assert (track.weights >= 0.0).all()
    assert track.weights.sum() == pytest.approx(1.0)
    assert (np.linalg.eigvalsh(track.covariance) > 0).all()
    assert track.state[:2] == pytest.approx((0.0, 0.0), abs=0.1)


def test_whether_the_ball_is_known_takes_no_prediction() -> None:
    tracker, asked = BallTracker(), BallTracker()
    for each in (tracker, asked):
        each.advance(PERIOD_S, 0.5)
        assert not each.known
        each.see(Sighting("a", True, np.array((1.0, 2.0)), np.eye(2) * 1e-3))
    known = []
    for _ in range(20):
        for each in (tracker, asked):
            each.advance(PERIOD_S, 0.5)
        known.append(asked.known)
        assert asked._current is None, "a prediction to the present is kept there"
        assert known[-1] == (tracker._at_now().filter is not None)
    assert known == [(tick + 1) * PERIOD_S <= 0.5 + 1e-9 for tick in range(20)]
    with pytest.raises(ValueError, match="not known"):
        _ = asked.track

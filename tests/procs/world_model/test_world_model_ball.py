"""The ball tracker on synthetic sightings: resting, rolling, kicked, seen by many; consistency and precedence."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from procs.model.ball import BALL, SLIDING_M_S2
from procs.model.frames import rotation
from procs.simulation.physics.rolling import RollingFriction
from procs.world_model.ball_filter import BallFilter, Mode
from procs.world_model.ball_track import Sighting
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.seen import Seen

Floats = NDArray[np.float64]
PERIOD_S = 0.05
ROLLING_M_S2 = 0.4
ROLLING_NOISE_M2_S3 = 0.01
"""Spectral density of the accelerations that the filter expects of a rolling ball."""


class Eye:
    """A robot at a fixed pose that sees the ball like an omnidirectional camera."""

    def __init__(self, name: str, place_m: tuple[float, float], seed: int, recognised: float = 0.95) -> None:
        self.name = name
        self.place_m = np.array(place_m)
        self.rng = np.random.default_rng(seed)
        self.recognised = recognised
        self.last: Floats | None = None

    def look(self, ball_m: Floats, own: bool = False, age_s: float = 0.0) -> Sighting | None:
        """Returns a noisy sighting with its true covariance, or None at times."""
        ray = ball_m - self.place_m
        distance_m = float(np.hypot(*ray))
        turn = rotation(math.atan2(ray[1], ray[0]))
        deviations_m = np.array((0.01 + 0.005 * distance_m**2, 0.01 + 0.003 * distance_m))
        noise_m = deviations_m * self.rng.standard_normal(2)
        seen = self.rng.random() < self.recognised
        self.last = ball_m + turn @ noise_m
        covariance_m2 = turn @ np.diag(deviations_m**2) @ turn.T
        return Sighting(self.name, own, self.last, covariance_m2, age_s) if seen else None


def rolling(start_m: tuple[float, float], velocity_m_s: tuple[float, float], frames: int) -> Iterator[Floats]:
    """Returns true states (4) of a ball that rolls freely."""
    position, velocity = np.array(start_m), np.array(velocity_m_s)
    for _ in range(frames):
        speed = float(np.hypot(*velocity))
        slower = velocity * max(0.0, 1 - ROLLING_M_S2 * PERIOD_S / max(speed, 1e-9))
        position = position + (velocity + slower) / 2 * PERIOD_S
        velocity = slower
        yield np.concatenate((position, velocity))


def follow(eyes: list[Eye], states: Iterator[Floats]) -> Floats:
    """Returns errors (frames, 4) of a tracker that gets all sightings: of its own robot, and of others at 10 Hz."""
    tracker = BallTracker()
    errors = []
    for frame, state in enumerate(states):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        for number, eye in enumerate(eyes):
            sighting = eye.look(state[:2], own=number == 0)
            if sighting is not None and (number == 0 or frame % 2 == 0):
                tracker.see(sighting)
        errors.append(tracker.track.state - state if tracker.known else np.full(4, np.nan))
    return np.array(errors)


def rms(errors: Floats) -> float:
    return float(np.sqrt(np.nanmean(np.sum(errors**2, axis=1))))


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


def test_kicked_ball_has_the_right_velocity_after_150_ms() -> None:
    speeds = []
    for seed in range(30):
        eye = Eye("a", (0, 0), seed, recognised=1.0)
        tracker = BallTracker()
        for state in [*rolling((1, 0.5), (0, 0), 20), *rolling((1, 0.5), (8, 0), 3)]:
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
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
        Error of the velocity in m/s after frame `counts_after`, and the mean weight of sliding.
    """
    errors, weights = [], []
    for seed in range(6):
        eyes = [Eye(f"r{i}", at, 10 * seed + i) for i, at in enumerate(places)]
        tracker = BallTracker()
        for frame, state in enumerate(hit(velocity_m_s, 20, frames)):
            if told_m_s and frame == 20:
                tracker.kick(np.array(told_m_s))
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2, contact=frame <= contact_until)
            for number, eye in enumerate(eyes):
                sighting = eye.look(state[:2], own=number == 0) if (frame + number) % 2 else None
                if sighting is not None:
                    tracker.see(sighting)
            if frame > counts_after:
                errors.append(tracker.track.state - state)
                weights.append(tracker.track.weights[Mode.SLIDES])
    return rms(np.array(errors)[:, 2:]), float(np.mean(weights))


def test_ball_that_an_opponent_hit_is_known_to_slide() -> None:
    """Nothing announces the kick; the time since a robot was near tells until when the ball slides."""
    error_m_s, slides = follow_hit((9.0, 2.7), 40, [(-2.0, 1.0), (2.0, -2.0), (1.0, 3.0)], 20, 26)
    assert error_m_s < 0.2
    assert slides > 0.8


def test_kicked_ball_slides_although_the_kicker_is_near() -> None:
    """For two ticks the kicker might touch the ball again; the known speed still tells that the ball slides."""
    error_m_s, slides = follow_hit((3.8, 0.8), 32, [(-2.0, 1.0), (2.0, -2.0)], 22, 25, told_m_s=(3.7, 0.7))
    assert slides > 0.8
    assert error_m_s < 0.2


def test_free_ball_that_is_not_seen_is_hardly_expected_to_be_hit() -> None:
    tracker, eye = BallTracker(), Eye("a", (0, 0), 3, recognised=1.0)
    for frame, state in enumerate(rolling((-2.0, 1.0), (1.5, 0.3), 66)):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        sighting = eye.look(state[:2], own=True)
        if sighting is not None and frame < 60:
            tracker.see(sighting)
    claimed_m_s = math.sqrt(np.trace(tracker.track.covariance[2:, 2:]))
    assert np.hypot(*(tracker.track.state - state)[2:]) < 2 * claimed_m_s < 0.9


def test_own_kick_is_believed_before_any_sighting() -> None:
    tracker = BallTracker()
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.hold("a", np.array((0.33, 0.0, 0.0, 0.0)), np.zeros((4, 4)))
    tracker.kick(np.array((8.0, 0.0)))
    tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.1)
    tracker.see(Sighting("a", True, np.array((0.73, 0.0)), np.eye(2) * 0.02**2))
    assert tracker.age_s == 0.0, "the sighting fits"
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.25)


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
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
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
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        place = (5.0, 5.0) if frame == 15 else (1.0, 1.0)
        tracker.see(Sighting("a", True, np.array(place), np.eye(2) * 0.02**2))
        assert (tracker.age_s == 0.0) == (frame != 15)
    assert tracker.track.state[:2] == pytest.approx((1.0, 1.0), abs=0.02)


def test_moved_ball_is_found_with_the_second_sighting() -> None:
    tracker = BallTracker()
    for frame in range(12):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        place = (1.0, 1.0) if frame < 10 else (-3.0, 0.0)
        tracker.see(Sighting("a", True, np.array(place), np.eye(2) * 0.02**2))
    assert tracker.track.state[:2] == pytest.approx((-3.0, 0.0), abs=0.05)


def test_own_sighting_precedes_an_equally_accurate_mate() -> None:
    tracker = BallTracker()
    own, other = np.array((1.0, 1.0)), np.array((2.5, 1.0))
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.see(Sighting("me", True, own, np.eye(2) * 0.03**2))
        tracker.see(Sighting("mate", False, other, np.eye(2) * 0.03**2))
        assert tracker.track.state[:2] == pytest.approx(own, abs=0.02)
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.see(Sighting("mate", False, other, np.eye(2) * 0.03**2))
    assert tracker.track.state[:2] == pytest.approx(other, abs=0.1)


def test_old_sighting_is_used_for_its_own_time() -> None:
    history = list(rolling((-4.0, 0.0), (3.0, 0.0), 60))
    errors = []
    for seed in range(10):
        eye = Eye("mate", (0.0, -2.0), seed, recognised=1.0)
        tracker = BallTracker()
        for now, then in zip(history[3:], history, strict=False):
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
            sighting = eye.look(then[:2], age_s=3 * PERIOD_S)
            assert sighting is not None
            tracker.see(sighting)
            errors.append(tracker.track.state[0] - now[0])
    assert abs(np.mean(errors)) < 0.05, "0.4 m behind without the age"


def test_late_sighting_from_before_a_kick_does_not_undo_it() -> None:
    """An opponent kicks a resting ball; the own camera sees it fly, a mate's sightings come 0.15 s late."""
    tracker = BallTracker()
    places_m = [max(0.0, 7.0 * (frame - 12) * PERIOD_S) for frame in range(20)]
    for frame, x_m in enumerate(places_m):
        tracker.advance(PERIOD_S, 2.0, 0.0, contact=True)
        tracker.see(Sighting("me", True, np.array((x_m, 0.0)), np.eye(2) * 0.02**2))
        if frame >= 3:
            late_m = np.array((places_m[frame - 3], 0.0))
            tracker.see(Sighting("mate", False, late_m, np.eye(2) * 0.02**2, age_s=3 * PERIOD_S))
        if frame >= 14:
            assert tracker.track.state[:2] == pytest.approx((x_m, 0.0), abs=0.06)
            assert tracker.track.state[2:] == pytest.approx((7.0, 0.0), abs=0.9)


def test_order_of_arrival_does_not_matter() -> None:
    def state(late: bool) -> Floats:
        tracker, rng = BallTracker(), np.random.default_rng(3)
        held: list[Sighting] = []
        for frame in range(16):
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
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
    tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
    tracker.see(Sighting("a", True, np.zeros(2), np.eye(2) * 0.01))
    for _ in range(39):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
    assert tracker.known
    assert tracker.age_s == pytest.approx(1.95)
    assert tracker.observers == 0
    for _ in range(3):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
    assert not tracker.known


def test_held_ball_is_in_the_mouth_whatever_the_cameras_say() -> None:
    tracker = BallTracker()
    for frame in range(5):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.hold("me", np.array((0.33 + frame * PERIOD_S, 0.0, 1.0, 0.0)), np.zeros((4, 4)))
        tracker.see(Sighting("mate", False, np.array((3.0, 3.0)), np.eye(2) * 0.01**2))
        assert tracker.track.state == pytest.approx((0.33 + frame * PERIOD_S, 0.0, 1.0, 0.0), abs=0.06)


def test_cameras_outrank_the_kickers_old_sighting() -> None:
    """A mate saw the ball sharply, then kicked it; the robot's own camera gives a frame every second tick."""
    tracker = BallTracker()
    for _ in range(6):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.see(Sighting("kicker", False, np.array((1.0, 0.0)), np.eye(2) * 0.005**2))
    for frame in range(1, 5):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        ball_m = np.array((1.0 + 8.0 * frame * PERIOD_S, 0.0))
        if frame % 2 == 0:
            tracker.see(Sighting("me", True, ball_m, np.eye(2) * 0.06**2))
    assert np.hypot(*(tracker.track.state[:2] - ball_m)) < 0.1
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.1)


def test_older_second_sighting_gives_place_and_velocity() -> None:
    tracker = BallTracker()
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.see(Sighting("me", True, np.array((0.0, 0.0)), np.eye(2) * 0.02**2))
    tracker.advance(PERIOD_S, 2.0, 0.0)
    tracker.see(Sighting("me", True, np.array((2.0, 0.0)), np.eye(2) * 0.02**2))
    tracker.see(Sighting("mate", False, np.array((1.8, 0.0)), np.eye(2) * 0.02**2, age_s=0.04))
    assert tracker.track.state[0] == pytest.approx(2.0, abs=0.05)
    assert tracker.track.state[2] == pytest.approx(5.0, abs=1.0)


def test_held_ball_is_as_uncertain_as_the_own_pose() -> None:
    tracker = BallTracker()
    covariance = np.diag((0.1**2, 0.2**2, 0.0, 0.0))
    for _ in range(3):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.hold("me", np.array((0.33, 0.0, 0.0, 0.0)), covariance)  # the pose's error persists from tick to tick
    assert np.sqrt(np.diag(tracker.track.covariance)[:2]) == pytest.approx((0.1, 0.2), rel=0.05)


def inside_95(states: list[Floats], contacts: list[bool], runs: int = 12) -> float:
    """Returns the share of ticks in which the true position lies in the filter's 95 % ellipse."""
    inside = []
    for seed in range(runs):
        eyes = [Eye(f"r{number}", place, 31 * seed + number) for number, place in enumerate([(-2.0, 1.0), (3.0, -3.0)])]
        tracker = BallTracker()
        for frame, (state, contact) in enumerate(zip(states, contacts, strict=True)):
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2, contact)
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


def test_ball_that_bounces_off_a_robot_is_followed_at_once() -> None:
    """After 0.15 s the error of the velocity is a tenth of the change."""
    errors = []
    for seed in range(20):
        eye, tracker = Eye("a", (0, 0), seed, recognised=1.0), BallTracker()
        for frame, state in enumerate([*rolling((-2, 1), (4.0, 0), 12), *rolling((0.3, 1), (-2.0, 1.0), 3)]):
            tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2, contact=frame >= 10)
            sighting = eye.look(state[:2], own=True)
            assert sighting is not None
            tracker.see(sighting)
        errors.append(np.hypot(*(tracker.track.state[2:] - state[2:])))
    assert np.median(errors) < 0.6


def test_ball_stays_within_the_walls() -> None:
    track = BallFilter(np.array((11.5, 0.0)), np.eye(2) * 0.01**2)
    track.kick(np.array((8.0, 1.0)))
    for _ in range(20):
        track.predict(PERIOD_S, ROLLING_M_S2)
        track.stay_within(11.89, 7.89)
        assert track.state[0] <= 11.89
    assert track.state[2] < 0.0, "it comes back"


def test_covariance_stays_symmetric_and_positive() -> None:
    rng = np.random.default_rng(1)
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01)
    for _ in range(400):
        track.predict(PERIOD_S, ROLLING_M_S2, contact=True)
        track.see(rng.standard_normal(2) * 0.1, np.diag(rng.uniform(1e-6, 0.1, 2)))
        assert (np.linalg.eigvalsh(track.covariance) > 0).all()
        assert track.covariance == pytest.approx(track.covariance.T, abs=1e-12)


def test_sighting_from_before_a_kick_tells_nothing() -> None:
    """A mate's camera was exposed before the robot's own kick; its message arrives after the kick."""
    tracker = BallTracker()
    for _ in range(4):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
        tracker.hold("me", np.array((0.33, 0.0, 0.0, 0.0)), np.zeros((4, 4)))
    tracker.kick(np.array((8.0, 0.0)))
    tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2)
    tracker.see(Sighting("mate", False, np.array((0.33, 0.0)), np.eye(2) * 0.01**2, age_s=0.1))
    assert tracker.track.state[2] == pytest.approx(8.0, rel=0.03)


def test_long_step_is_as_sound_as_many_short_ones() -> None:
    """A step may be as long as the age of a message; no probability becomes negative."""
    track = BallFilter(np.zeros(2), np.eye(2) * 0.01)
    for _ in range(10):
        track.predict(0.5, ROLLING_M_S2, contact=True)
        track.see(np.zeros(2), np.eye(2) * 0.01)
    assert (track.weights >= 0.0).all()
    assert track.weights.sum() == pytest.approx(1.0)
    assert (np.linalg.eigvalsh(track.covariance) > 0).all()
    assert track.state[:2] == pytest.approx((0.0, 0.0), abs=0.1)


def test_kick_of_a_mate_begins_at_its_mouth() -> None:
    """Cameras have already shown a part of the flight, which must not count twice."""
    tracker = BallTracker()
    for frame in range(8):
        tracker.advance(PERIOD_S, 2.0, ROLLING_M_S2, contact=True)
        flight_s = max(0, frame - 5) * PERIOD_S
        ball_m = np.array((8.0 * flight_s - SLIDING_M_S2 / 2 * flight_s**2, 0.0))
        tracker.see(Sighting("me", True, ball_m, np.eye(2) * 0.05**2))
    mouth = Seen.of([(0.0, 0.0)], [np.eye(2) * 0.03**2], [0.0])
    tracker.kick(np.array((8.0, 0.0)), 0.1, mouth)
    assert tracker.track.state[0] == pytest.approx(0.8, abs=0.03)
    assert tracker.track.state[2] == pytest.approx(7.7, abs=0.1)

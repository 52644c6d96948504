"""A ball in the air: parabola, bounces, sightings by size; lobs of mates and rivals. A ball that enters a mouth."""

import math
from collections.abc import Iterator
from itertools import islice

import numpy as np
import pytest

from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.simulation.physics.ball_body import GRAVITY_M_S2
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.flight import Flight
from procs.world_model.sighting import Sighting
from procs.world_model.walls import Walls
from tests.procs.world_model.eyes import PERIOD_S, Floats
from tests.procs.world_model.team_on_bench import Robot, team

LIFT_M_S, SPEED_M_S = 4.0, 9.0
REACHES_BALL = 0.995
"""Probability that a told kick reached the ball; the mean velocity is that share of the kick's."""
EYE_M = np.array((2.0, -2.0))
VIEWPOINT_M = 0.64  # above the middle of a ball on the ground


def lobbed(lift_m_s: float = LIFT_M_S, speed_m_s: float = SPEED_M_S) -> Iterator[tuple[Floats, Floats]]:
    """Yields place (3) and velocity (3) of a ball that is kicked at the origin along x, and bounces."""
    place, velocity, step_s = np.zeros(3), np.array((speed_m_s, 0.0, lift_m_s)), 0.001
    while True:
        for _ in range(round(PERIOD_S / step_s)):
            place = place + velocity * step_s
            velocity = velocity - (0.0, 0.0, GRAVITY_M_S2 * step_s)
            if place[2] <= 0.0:
                place[2], rebound_m_s = 0.0, -BALL.bounce * velocity[2]
                velocity[2] = max(0.0, rebound_m_s)
        yield place, velocity


def seen(place: Floats, rng: np.random.Generator, own: bool = True) -> Sighting | None:
    """Returns how a robot sees a ball: not above the mirror; at its height, unless it hardly flies."""
    if place[2] > VIEWPOINT_M - 0.1:
        return None
    if place[2] < 0.04:
        appears_m = EYE_M + (place[:2] - EYE_M) * VIEWPOINT_M / (VIEWPOINT_M - place[2])
        return Sighting("a", own, appears_m, np.eye(2) * 0.02**2, observer_m=EYE_M)
    noisy = place + 0.02 * rng.standard_normal(3)
    return Sighting("a", own, noisy[:2], np.eye(2) * 0.03**2, height_m=float(noisy[2]), observer_m=EYE_M)


def just_lobbed(lift_m_s: float) -> BallTracker:
    """Returns the tracker of a robot that has just kicked the ball from the origin along x."""
    tracker = BallTracker()
    tracker.advance(PERIOD_S, 2.0)
    tracker.hold("a", np.zeros(4), np.zeros((4, 4)))
    tracker.kick(np.array((SPEED_M_S, 0.0)), lift_m_s=lift_m_s)
    return tracker


def test_flight_is_a_parabola_with_bounces() -> None:
    flight = Flight.of_kick(LIFT_M_S)
    for place, velocity in islice(lobbed(), 27):
        assert flight is not None
        flight, grounded_s = flight.moved(PERIOD_S, BALL)
        assert flight is not None
        assert grounded_s == 0.0
        assert flight.height_m == pytest.approx(place[2], abs=0.03)
        assert flight.lift_m_s == pytest.approx(velocity[2], abs=0.15)


def test_low_bounces_end_the_flight_and_the_carpet_acts_again() -> None:
    flight = Flight.of_kick(0.6)
    assert flight is not None
    landed, grounded_s = flight.moved(0.2, BALL)
    assert landed is None
    assert grounded_s == pytest.approx(0.2 - 2 * 0.6 / GRAVITY_M_S2)


@pytest.mark.parametrize("bounce", [0.6, 0.75, 0.9])
def test_bounces_end_even_if_the_settings_have_no_least(bounce: float) -> None:
    """The bounces of a ball that keeps a share of its lift last for a finite time, however small they become."""
    flight = Flight.of_kick(2.0)
    assert flight is not None
    lasts_s = 2 * 2.0 / GRAVITY_M_S2 / (1 - bounce)
    landed, grounded_s = flight.moved(lasts_s + 1.0, BallModel(bounce=bounce, least_rebound_m_s=0.0))
    assert landed is None
    assert grounded_s == pytest.approx(1.0, abs=0.03)


def test_ball_that_never_stops_bouncing_stays_in_the_air() -> None:
    flight = Flight.of_kick(2.0)
    for _ in range(200):
        assert flight is not None
        flight, grounded_s = flight.moved(PERIOD_S, BallModel(bounce=1.0, least_rebound_m_s=0.0))
        assert grounded_s == 0.0


def test_kick_along_the_ground_is_no_flight() -> None:
    assert Flight.of_kick(0.0) is None
    assert Flight.of_sight(0.0) is None


def test_own_lob_is_known_without_any_sighting() -> None:
    tracker = just_lobbed(LIFT_M_S)
    for place, velocity in islice(lobbed(), 15):
        tracker.advance(PERIOD_S, 2.0)
        assert tracker.track.state[:2] == pytest.approx(place[:2], abs=0.05)
        assert tracker.track.state[2] == pytest.approx(REACHES_BALL * velocity[0], abs=0.02)
        assert tracker.flight is not None
        assert tracker.flight.height_m == pytest.approx(place[2], abs=0.03)


@pytest.mark.parametrize("lift_m_s", [3.0, 4.0])
def test_lob_of_a_rival_is_known_by_the_balls_size(lift_m_s: float) -> None:
    rng, tracker, errors_m = np.random.default_rng(4), BallTracker(), []
    for _ in range(10):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        tracker.see(Sighting("a", True, 0.01 * rng.standard_normal(2), np.eye(2) * 0.02**2, observer_m=EYE_M))
    for tick, (place, _) in enumerate(islice(lobbed(lift_m_s), 20)):
        tracker.advance(PERIOD_S, 2.0, contact=1.0 if tick == 0 else 0.0)
        sighting = seen(place, rng)
        if sighting is not None:
            tracker.see(sighting)
        if tick >= 2:
            flight = tracker.flight
            errors_m.append(
                (math.dist(tracker.track.state[:2], place[:2]), (flight.height_m if flight else 0) - place[2])
            )
    assert np.max(np.abs(errors_m), axis=0) == pytest.approx((0.0, 0.0), abs=0.35)


def test_lob_of_a_mate_is_told_by_radio() -> None:
    cyan = team()
    ball_m = np.array((0.0, 0.0))
    for _ in range(20):
        cyan.tick(ball_m)
    kicker = cyan.robots[0]
    kick(kicker, LIFT_M_S)
    cyan.tick(None)
    cyan.tick(None)
    for robot in cyan.robots:
        ball = robot.world.ball
        assert ball.vz_m_s == pytest.approx(LIFT_M_S - GRAVITY_M_S2 * 1.5 * PERIOD_S, abs=0.6)
        assert ball.z_m > 0.1
        assert math.hypot(ball.vx_m_s, ball.vy_m_s) == pytest.approx(SPEED_M_S, rel=0.05)


def kick(robot: Robot, lift_m_s: float) -> None:
    """Lets the kicker of a robot report a lob with its next frame."""
    sense = robot.sense

    def kicking(*args: object, **kwargs: object) -> None:
        sense(*args, **kwargs)  # type: ignore[arg-type]
        robot.bench.port("kicker_state").put(
            kicks=1, kick_speed_m_s=SPEED_M_S, kick_elevation_rad=math.atan2(lift_m_s, SPEED_M_S)
        )

    robot.sense = kicking  # type: ignore[method-assign]


def test_ball_that_flies_is_not_braked_and_one_that_landed_is() -> None:
    def after(lift_m_s: float, ticks: int) -> float:
        tracker = just_lobbed(lift_m_s)
        for _ in range(ticks):
            tracker.advance(PERIOD_S, 5.0)
        return float(tracker.track.state[2])

    assert after(LIFT_M_S, 10) == pytest.approx(REACHES_BALL * SPEED_M_S, abs=0.02)
    assert after(0.0, 10) == pytest.approx(SPEED_M_S - 10 * PERIOD_S * BALL.sliding_m_s2, abs=0.1)
    assert after(LIFT_M_S, 60) < SPEED_M_S - 2.0


def test_sighting_at_another_height_does_not_fit() -> None:
    """An orange thing on the ground below the ball is another one."""
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(4):
        tracker.advance(PERIOD_S, 2.0)
    before_m = tracker.track.state
    tracker.see(Sighting("a", True, before_m[:2] + 0.1, np.eye(2) * 0.02**2, observer_m=EYE_M))
    assert tracker.track.state == pytest.approx(before_m)


def test_ball_that_bounced_keeps_its_way_over_the_ground() -> None:
    """The height does not fit, the place does: the ball has met the ground sooner than was believed."""
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(6):
        tracker.advance(PERIOD_S, 2.0)
    before = tracker.track.state
    tracker.see(Sighting("a", True, before[:2], np.eye(2) * 0.02**2, height_m=0.1, observer_m=EYE_M))
    assert tracker.track.state == pytest.approx(before, abs=0.1)
    assert tracker.flight is not None
    assert tracker.flight.height_m == pytest.approx(0.1)


def test_lob_that_met_something_is_found_with_one_sighting() -> None:
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(8):
        tracker.advance(PERIOD_S, 2.0)
    place_m = np.array((1.0, 0.5))
    tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.02**2, height_m=0.3, observer_m=EYE_M))
    assert tracker.track.state[:2] == pytest.approx(place_m)
    assert tracker.flight is not None
    assert tracker.flight.height_m == pytest.approx(0.3)


def test_unseen_lob_does_not_jump_to_a_thing_that_lies() -> None:
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(8):
        tracker.advance(PERIOD_S, 2.0)
    before_m = tracker.track.state
    tracker.see(Sighting("a", True, np.array((1.0, 2.5)), np.eye(2) * 0.1**2, observer_m=EYE_M))
    assert tracker.track.state == pytest.approx(before_m)
    assert tracker.flight is not None


def test_lob_that_met_something_keeps_its_height() -> None:
    """Something turns a lob aside a moment after the kick: the way over the ground is new, the parabola is not."""
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(3):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
    before = tracker.flight
    assert before is not None
    place_m = tracker.track.state[:2] + np.array((-0.3, 0.5))
    tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.02**2, height_m=before.height_m, observer_m=EYE_M))
    assert tracker.track.state[:2] == pytest.approx(place_m, abs=0.02)
    assert tracker.flight is not None
    assert tracker.flight.lift_m_s == pytest.approx(before.lift_m_s, abs=0.02)


@pytest.mark.parametrize(("aside_m", "jumps"), [(0.0, False), (0.15, False), (0.9, True)])
def test_half_hidden_lob_seems_to_lie_further_away_on_its_ray(aside_m: float, jumps: bool) -> None:
    tracker, rng = just_lobbed(LIFT_M_S), np.random.default_rng(2)
    for tick, (place, _) in enumerate(islice(lobbed(), 4)):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        if tick < 3 and (sighting := seen(place, rng)):
            tracker.see(sighting)
    ray_m = (place[:2] - EYE_M) / np.hypot(*(place[:2] - EYE_M))
    behind_m = place[:2] + 0.9 * ray_m + aside_m * np.array((-ray_m[1], ray_m[0]))
    tracker.see(Sighting("b", False, behind_m, np.eye(2) * 0.1**2, observer_m=EYE_M))
    assert (tracker.flight is None) is jumps
    assert bool(np.hypot(*(tracker.track.state[:2] - place[:2])) > 0.5) is jumps


def test_slow_ball_that_seems_to_fly_low_does_not_jump() -> None:
    """A robot sees a half hidden ball in the air for a moment; another errs about the ball's place."""
    tracker = BallTracker()
    for _ in range(20):
        tracker.advance(PERIOD_S, 2.0)
        tracker.see(Sighting("a", False, np.zeros(2), np.eye(2) * 0.02**2, observer_m=EYE_M))
    tracker.see(Sighting("b", False, np.zeros(2), np.eye(2) * 0.05**2, height_m=0.06, observer_m=EYE_M))
    tracker.advance(PERIOD_S / 2, 2.0)
    for _ in range(2):
        tracker.see(Sighting("a", False, np.zeros(2), np.eye(2) * 0.02**2, observer_m=EYE_M))
    assert tracker.flight is not None
    tracker.advance(PERIOD_S / 2, 2.0)
    tracker.see(Sighting("b", False, np.array((0.6, 0.0)), np.eye(2) * 0.05**2, observer_m=EYE_M))
    assert tracker.track.state == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=0.1)


def test_ball_on_the_ground_ends_a_flight_of_uncertain_place() -> None:
    """A robot believes in a long lob; another sees the ball on the ground, where it may well be."""
    tracker = just_lobbed(LIFT_M_S)
    for _ in range(6):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
    assert tracker.flight is not None
    place_m = tracker.track.state[:2] + 0.3
    tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.02**2, observer_m=EYE_M))
    assert tracker.track.state[:2] == pytest.approx(place_m, abs=0.1)
    assert tracker.flight is None


def test_ball_leaves_the_ground_only_with_a_reason() -> None:
    tracker = BallTracker()
    walls = Walls.of(Field(), BALL)
    for _ in range(30):
        tracker.advance(PERIOD_S, 2.0, contact=1.0, walls=walls)
        tracker.see(Sighting("a", True, np.zeros(2), np.eye(2) * 0.02**2, observer_m=EYE_M))
        assert tracker.flight is None


def test_ball_behind_the_net_of_a_goal_is_believed_there() -> None:
    tracker, place_m = BallTracker(), np.array((11.8, 0.4))
    for _ in range(20):
        tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.03**2, observer_m=EYE_M))
        tracker.advance(PERIOD_S, 2.0, walls=Walls.of(Field(), BALL))
    assert tracker.track.state[:2] == pytest.approx(place_m, abs=0.02)


@pytest.mark.parametrize(("height_m", "stops"), [(0.0, True), (2.0, False)])
def test_net_stops_a_ball_unless_it_flies_over(height_m: float, stops: bool) -> None:
    tracker, reached_m = BallTracker(), 0.0
    for tick in range(9):
        tracker.advance(PERIOD_S, 2.0, walls=Walls.of(Field(), BALL))
        if tick < 2:
            place_m = np.array((10.5 + 4.0 * PERIOD_S * tick, 0.0))
            tracker.see(Sighting("a", True, place_m, np.eye(2) * 0.02**2, height_m=height_m, observer_m=EYE_M))
        reached_m = max(reached_m, float(tracker.track.state[0]))
    assert (reached_m < 11.5) is stops


def test_ball_in_the_mouth_keeps_its_speed_until_it_touches() -> None:
    """The light barrier sees the ball a few centimetres before the mouth stops it."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), 3, sight_correlation=1.0)
    mouth_m = robot.bench.component._mouth_m
    for tick in range(30):
        gap_m = 3.0 * PERIOD_S * (28.2 - tick)
        robot.sense(np.array((mouth_m + max(0.0, gap_m), 0.0)), [], held=gap_m < 0.04)
        robot.bench.iterate()
        if tick == 28:
            assert robot.world.ball.vx_m_s == pytest.approx(-3.0, abs=0.5)
    assert robot.world.ball.vx_m_s == pytest.approx(0.0, abs=0.3)

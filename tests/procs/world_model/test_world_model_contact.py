"""Robots near the ball: by their reach, their approach, a ball that leaves them, and one that runs into them."""

import math

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import NO_CONTACT, Contact
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.contact import RobotRow, Robots
from procs.world_model.flight import Flight
from procs.world_model.sighting import Sighting

TOUCH_M = 0.33
ROBOT_M2 = 0.03**2
STEP_S = 0.05


def ball(speed_m_s: float = 0.0) -> BallFilter:
    """Returns a ball at the origin, known well; with a speed it was kicked along x."""
    found = BallFilter(np.zeros(2), np.eye(2) * 0.01**2, BALL)
    if speed_m_s:
        found.kick(np.array((speed_m_s, 0.0)))
    else:
        found.hold(np.zeros(4), np.eye(4) * 0.01**2)
    return found


def robots(*rows: RobotRow) -> Robots:
    return Robots(rows, TOUCH_M, height_m=0.8)


def met(found: BallFilter, x_m: float, y_m: float = 0.0, vx_m_s: float = 0.0, robot_m2: float = ROBOT_M2) -> Contact:
    """Returns what a robot does to the ball in a step at whose beginning it is at x, y."""
    return robots((x_m + vx_m_s * STEP_S, y_m, vx_m_s, 0.0, robot_m2)).contact(found, STEP_S, before_s=STEP_S)


@pytest.mark.parametrize(
    ("x_m", "vx_m_s", "speed_m_s", "expected"),
    [
        (0.35, 0.0, 0.0, True),
        (0.75, 0.0, 0.0, False),
        (0.5, -3.0, 0.0, True),
        (0.6, 3.0, 0.0, False),
        (-0.35, 0.0, 4.0, False),
        (-0.35, 3.5, 4.0, True),
        (0.55, 0.0, 4.0, True),
    ],
)
def test_robot_within_reach_touches(x_m: float, vx_m_s: float, speed_m_s: float, expected: bool) -> None:
    probability = met(ball(speed_m_s), x_m, vx_m_s=vx_m_s).probability
    assert probability > 0.5 if expected else probability < 0.05


def test_robot_that_follows_the_ball_hardly_touches_it() -> None:
    """A gap of 0.2 m, well known, makes a touch improbable; the same gap with an uncertain robot does not."""
    assert met(ball(), 0.56).probability < 0.01
    assert met(ball(), 0.56, robot_m2=0.2**2).probability > 0.1


def test_without_robots_no_contact() -> None:
    assert robots().contact(ball(), STEP_S, before_s=STEP_S) == NO_CONTACT


@pytest.mark.parametrize(
    ("speed_m_s", "x_m", "y_m", "likely"),
    [
        pytest.param(8.0, 0.5, 0.0, True, id="fast and head on"),
        pytest.param(8.0, 0.9, 0.0, False, id="not there yet"),
        pytest.param(8.0, 0.2, 0.5, False, id="past it"),
        pytest.param(1.5, 0.3, 0.0, False, id="slow enough to be caught"),
        pytest.param(8.0, -0.3, 0.0, False, id="away from the kicker"),
    ],
)
def test_ball_cannot_run_on_through_a_robot(speed_m_s: float, x_m: float, y_m: float, likely: bool) -> None:
    hit = met(ball(speed_m_s), x_m, y_m).hit
    assert hit > 0.9 if likely else hit < 0.1


def test_hit_head_on_turns_the_ball_back_and_aside_turns_it() -> None:
    head_on = met(ball(8.0), 0.5)
    assert 8.0 + head_on.change_x_m_s == pytest.approx(-1.6, abs=0.1)
    assert head_on.change_y_m_s == pytest.approx(0.0, abs=0.01)
    assert head_on.after_s == pytest.approx((0.5 - TOUCH_M) / 8.0, abs=0.001)
    aside = met(ball(8.0), 0.3, 0.2)
    assert aside.change_y_m_s < -1.0
    assert 0.0 < 8.0 + aside.change_x_m_s < 8.0


def test_place_of_a_robot_is_that_of_the_beginning_of_a_step() -> None:
    """A robot that comes at 4 m/s was 0.4 m further away a tenth of a second before."""
    now = robots((0.4, 0.0, -4.0, 0.0, ROBOT_M2))
    assert now.contact(ball(), STEP_S, before_s=0.0).probability > 0.9
    assert now.contact(ball(), STEP_S, before_s=0.1).probability < 0.01


def test_far_robots_are_left_out() -> None:
    rows = [(1.0, 0.0, 0.0, 0.0, ROBOT_M2), (0.0, 6.0, 0.0, 0.0, ROBOT_M2)]
    assert Robots.near(ball(), rows, TOUCH_M, 0.8).rows == (rows[0],)


def shot_at(robot: Robots | None, ticks: int) -> BallTracker:
    """Returns the track of a ball that was kicked at 8 m/s, after some ticks without a sighting."""
    tracker = BallTracker()
    for _ in range(4):
        tracker.advance(STEP_S, 2.0)
        tracker.hold("me", np.zeros(4), np.eye(4) * 1e-4)
    tracker.kick(np.array((8.0, 0.0)), -STEP_S / 2)
    for _ in range(ticks):
        tracker.advance(STEP_S, 2.0, robots=robot)
    return tracker


def test_kicked_ball_stops_at_a_robot_without_a_sighting() -> None:
    tracker = shot_at(robots((0.9, 0.0, 0.0, 0.0, ROBOT_M2)), 5)
    assert tracker.track.state[0] < 0.9, "on the kicker's side of the robot"
    assert shot_at(None, 5).track.state[0] > 1.5


def test_ball_that_flies_over_a_robot_is_not_hit() -> None:
    tracker = BallTracker()
    tracker.advance(STEP_S, 2.0)
    tracker.hold("me", np.zeros(4), np.eye(4) * 1e-4)
    tracker.kick(np.array((5.0, 0.0)), -STEP_S / 2, lift_m_s=5.0)
    for _ in range(10):
        tracker.advance(STEP_S, 2.0, robots=robots((1.9, 0.0, 0.0, 0.0, ROBOT_M2)))
    assert tracker.track.state[0] == pytest.approx(5.0 * 0.475, abs=0.1)


@pytest.mark.parametrize(
    ("height_m", "lift_m_s", "likely"),
    [
        pytest.param(0.75, 0.0, True, id="low"),
        pytest.param(0.75, 4.0, False, id="rises over it"),
        pytest.param(0.85, -4.0, True, id="falls upon it"),
        pytest.param(0.85, 0.0, False, id="high"),
    ],
)
def test_height_counts_where_the_ball_meets_the_robot(height_m: float, lift_m_s: float, likely: bool) -> None:
    """A lob that rose above a rival within the tick seemed to bounce off, and its kicker lost it."""
    flight = Flight(height_m, lift_m_s, 0.01**2, 0.0, 0.1**2)
    found = robots((0.6, 0.0, 0.0, 0.0, ROBOT_M2)).contact(ball(11.5), STEP_S, STEP_S, flight)
    for probability in (found.hit, found.probability):
        assert probability > 0.8 if likely else probability < 0.1


@pytest.mark.parametrize(
    ("y_m", "height_m", "likely"),
    [
        pytest.param(0.2, 0.66, True, id="low"),
        pytest.param(0.2, 0.85, False, id="over it"),
        pytest.param(0.6, 0.66, False, id="beside it"),
    ],
)
def test_rising_ball_is_hit_in_the_step_in_which_it_touches(y_m: float, height_m: float, likely: bool) -> None:
    """A lob touched a robot low; at the end of the step it would have been above: beliefs flew on, for 10 m."""
    flight, row = Flight(height_m, 4.0, 0.01**2, 0.0, 0.1**2), (0.45, y_m, 0.0, 0.0, ROBOT_M2)
    found = robots(row).contact(ball(9.5), STEP_S / 2, STEP_S / 2, flight)
    assert found.hit > 0.8 if likely else found.hit < 0.1


def test_ball_above_a_robot_has_passed_or_met_it_before() -> None:
    flight = Flight(0.75, 4.0, 0.05**2, 0.0, 0.1**2)
    assert robots((0.2, 0.0, 0.0, 0.0, ROBOT_M2)).contact(ball(9.5), STEP_S, STEP_S, flight).hit == 0.0


def test_deflected_ball_is_found_by_the_next_sighting() -> None:
    """The ball left a robot sideways; one frame suffices, where the model of a free ball needs two."""
    tracker = shot_at(robots((0.9, 0.1, 0.0, 0.0, ROBOT_M2)), 3)
    place_m = np.array((0.6, -0.35))
    tracker.see(Sighting("me", True, place_m, np.eye(2) * 0.03**2))
    assert math.dist(tracker.track.state[:2], place_m) < 0.1


def test_kick_that_missed_the_ball_is_forgotten_at_a_sighting() -> None:
    """The kicker reported a kick, but the ball lies where it was."""
    tracker = shot_at(None, 2)
    tracker.see(Sighting("me", True, np.zeros(2), np.eye(2) * 0.03**2))
    assert tracker.track.state == pytest.approx(np.zeros(4), abs=0.1)
    assert shot_at(None, 2).track.state[2] == pytest.approx(7.6, abs=0.2), "kicks are believed"

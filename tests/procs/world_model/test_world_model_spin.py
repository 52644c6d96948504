"""The ball's spin and the carpet: where a slide ends, what a bounce leaves, and how fast the carpet brakes."""

from collections.abc import Iterator

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.model.field import Field
from procs.simulation.physics.rolling import RollingFriction
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import Mode
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.sighting import Sighting
from procs.world_model.walls import Walls
from tests.procs.world_model.eyes import PERIOD_S, ROLLING_M_S2, Eye, Floats


def run(
    spin_m_s: tuple[float, float], velocity_m_s: tuple[float, float], frames: int, carpet: float = 1.0
) -> Iterator[Floats]:
    """Returns true states (4) of a free ball with a spin, as in the simulation."""
    friction, position_m, velocity = RollingFriction(BALL, carpet), np.zeros(2), velocity_m_s
    friction.roll(*spin_m_s)
    for _ in range(frames):
        before = velocity
        velocity = friction.advance(*velocity, PERIOD_S)
        position_m = position_m + (np.array(before) + velocity) / 2 * PERIOD_S
        yield np.array((*position_m, *velocity))


def test_kick_of_a_driving_robot_slides_less() -> None:
    """The ball rolled along with the robot; without a sighting the end of the slide is foreseen."""
    tracker = BallTracker()
    for frame in range(20):
        tracker.advance(PERIOD_S, 2.0, contact=1.0)
        tracker.hold("me", np.array((2.0 * (frame - 20) * PERIOD_S, 0.0, 2.0, 0.0)), np.eye(4) * 1e-4)
    tracker.kick(np.array((5.5, 0.0)))
    states = [*run((2.0, 0.0), (5.5, 0.0), 18)]
    for _ in states:
        tracker.advance(PERIOD_S, 2.0)
    assert tracker.track.state[2] == pytest.approx(states[-1][2], abs=0.15)


def test_stopped_ball_goes_on_by_its_spin() -> None:
    """A robot stops a rolling ball; its spin drives it on, and it is not taken for a resting one."""
    track = BallFilter(np.zeros(2), np.eye(2) * 1e-4, BALL)
    for _ in range(20):
        track.predict(PERIOD_S, ROLLING_M_S2)
        track.hold(np.array((0.0, 0.0, 2.5, 0.0)), np.eye(4) * 1e-4)
    track.kick(np.array((0.05, 0.0)))
    states = [*run((2.5, 0.0), (0.05, 0.0), 6)]
    for _ in states:
        track.predict(PERIOD_S, ROLLING_M_S2)
    assert track.weights[Mode.RESTS] < 0.05
    assert track.state[2] == pytest.approx(states[-1][2], abs=0.15)


def followed(carpet: float, kicks: int) -> BallTracker:
    """Returns the tracker of a robot that kicked so often on a carpet and saw the ball roll away."""
    tracker, eye = BallTracker(), Eye("me", (0.0, 1.0), 5, recognised=1.0)
    for _ in range(kicks):
        for _ in range(10):
            tracker.advance(PERIOD_S, 2.0, contact=1.0)
            tracker.hold("me", np.zeros(4), np.eye(4) * 1e-4)
        tracker.kick(np.array((5.0, 0.0)))
        for state in run((0.0, 0.0), (5.0, 0.0), 25, carpet):
            tracker.advance(PERIOD_S, 2.0)
            sighting = eye.look(state[:2], own=True)
            assert sighting is not None
            tracker.see(sighting)
    return tracker


@pytest.mark.parametrize("carpet", [0.75, 1.25])
def test_carpet_is_learnt_from_slides(carpet: float) -> None:
    factor, variance = followed(carpet, 6).track.carpet
    assert factor == pytest.approx(carpet, abs=0.1)
    assert abs(factor - carpet) < 3 * np.sqrt(variance)


def test_carpet_outlives_the_ball() -> None:
    tracker = followed(0.75, 6)
    learnt = tracker.track.carpet
    for _ in range(50):
        tracker.advance(PERIOD_S, 2.0)
    assert not tracker.known
    tracker.see(Sighting("me", True, np.zeros(2), np.eye(2) * 0.01**2))
    assert tracker.track.carpet[0] == pytest.approx(learnt[0], abs=0.05)


def test_robot_that_errs_about_its_place_moves_no_ball() -> None:
    """Two robots see a resting ball at one place, by turns with a third, whose place is wrong by half a metre."""
    tracker, speeds_m_s = BallTracker(), []
    for frame in range(60):
        tracker.advance(PERIOD_S, 2.0)
        if frame % 2 == 0:
            tracker.see(Sighting("a", False, np.zeros(2), np.eye(2) * 0.05**2))
            tracker.see(Sighting("b", False, np.zeros(2), np.eye(2) * 0.05**2))
        elif frame > 20:
            tracker.see(Sighting("c", False, np.array((0.5, 0.0)), np.eye(2) * 0.04**2))
        speeds_m_s.append(np.hypot(*tracker.track.state[2:]))
    assert max(speeds_m_s[10:]) < 0.2


def test_walls_stand_at_the_border_of_the_field() -> None:
    field = Field()
    walls = Walls.of(field, BALL)
    assert walls.x_m == pytest.approx(field.half_length_m + field.border_m - BALL.radius_m)
    assert walls.y_m == pytest.approx(field.half_width_m + field.border_m - BALL.radius_m)


@pytest.mark.parametrize(
    ("place_m", "near"),
    [
        ((11.85, 3.0), True),
        ((0.0, -7.85), True),
        ((11.0, 1.3), True),
        ((10.5, 0.0), True),
        ((9.8, 0.0), False),
        ((0.0, 7.0), False),
    ],
)
def test_ball_is_near_walls_posts_and_keepers_only(place_m: tuple[float, float], near: bool) -> None:
    tracker = BallTracker()
    tracker.advance(PERIOD_S, 2.0)
    tracker.hold("me", np.array((*place_m, 0.0, 0.0)), np.eye(4) * 1e-6)
    assert Walls.of(Field(), BALL).near(tracker.track, PERIOD_S) is near


def unseen_at(place_m: tuple[float, float]) -> BallTracker:
    """Returns the tracker of a ball that was seen at rest for 1.5 s, and then not for 1.5 s."""
    tracker, walls = BallTracker(), Walls.of(Field(), BALL)
    for frame in range(60):
        near = tracker.known and walls.near(tracker.track, PERIOD_S)
        tracker.advance(PERIOD_S, 5.0, contact=float(near), walls=walls)
        if frame < 30:
            tracker.see(Sighting("me", True, np.array(place_m), np.eye(2) * 0.03**2))
    return tracker


def test_ball_at_rest_is_as_certain_at_a_wall_as_elsewhere() -> None:
    at_wall, elsewhere = unseen_at((3.0, 7.85)).track, unseen_at((3.0, 3.0)).track
    assert at_wall.state[:2] == pytest.approx((3.0, 7.85), abs=0.03)
    assert at_wall.covariance[0, 0] == pytest.approx(elsewhere.covariance[0, 0], rel=0.1)

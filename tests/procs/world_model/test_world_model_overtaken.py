"""Order of arrival: sightings and kicks count at their own times, also in messages that newer ones overtake."""

import math
from collections.abc import Iterable

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, team_message_t, world_model_t
from procs.model.robot import ROBOT
from procs.model.units import US_PER_S
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.kicks import Kicks
from procs.world_model.sighting import Sighting
from procs.world_model.told import mate_of
from procs.world_model.world_model import WorldModel

PERIOD_US = 40_000
SPREAD_M2 = [[4e-4, 0.0], [0.0, 4e-4]]


class Listener:
    """World model of a robot that sees nothing itself, and hears what the test says."""

    def __init__(self) -> None:
        self.bench = Bench(WorldModel, "cyan1/world_model", period_s=PERIOD_US / US_PER_S)

    @property
    def now_us(self) -> int:
        """Logical time of the next iteration."""
        return self.bench.time_us + PERIOD_US

    def tick(self, heard: Iterable[team_message_t] = ()) -> world_model_t:
        self.bench.port("pose").put(covariance=np.diag((1e-4, 1e-4, 1e-5)).tolist(), localized=True)
        self.bench.port("odometry").put()
        self.bench.port("kicker_state").put()
        if heard := list(heard):
            self.bench.port("team_inbox").put(messages=heard)
        self.bench.iterate()
        world: world_model_t = self.bench.port("world_model").sent[-1]
        return world

    def hear_of_rolling_ball(self, order: list[int]) -> world_model_t:
        """Hears of a ball at 2 m/s in messages of successive ticks; `order` is that of their arrival, in each group."""
        first_us = self.now_us
        for _ in range(6):
            said = []
            for _ in order:
                said.append(of_ball(self.now_us, 2.0 * (self.now_us - first_us) / US_PER_S))
                self.tick()
            for place in order:
                world = self.tick([said[place]])
        return world


def message(now_us: int) -> team_message_t:
    """Returns a message of a mate 5 m away."""
    said = team_message_t(robot="cyan2", number=2, localized=True, x_m=-5.0)
    said.pose_covariance = np.diag((1e-4, 1e-4, 1e-5)).tolist()
    said.header.time_us = now_us
    return said


def of_ball(now_us: int, x_m: float) -> team_message_t:
    """Returns a message of a mate that sees the ball."""
    said = message(now_us)
    said.ball_visible, said.ball_capture_us, said.ball_covariance_m2 = True, now_us, SPREAD_M2
    said.ball_x_m = x_m
    return said


def ball_of(world: world_model_t) -> list[float]:
    ball = world.ball
    return [ball.x_m, ball.y_m, ball.vx_m_s, ball.vy_m_s, *np.array(ball.covariance).ravel().tolist()]


@pytest.mark.parametrize("order", [[1, 0], [2, 0, 1], [2, 1, 0], [3, 1, 2, 0]])
def test_sightings_in_overtaken_messages_count(order: list[int]) -> None:
    found, in_turn = (ball_of(Listener().hear_of_rolling_ball(each)) for each in (order, sorted(order)))
    assert found == in_turn


def test_kick_in_an_overtaken_message_counts_once() -> None:
    """A mate kicks twice within 80 ms, and tells each kick twice; the message with the second kick comes first."""
    kicks, found = Kicks(ROBOT.fastest_ball_m_s), []
    for number, told_us, overtaken in ((3, 1_000_000, False), (5, 1_080_000, False), (4, 1_040_000, True)):
        for each_us in (told_us, told_us + PERIOD_US // 2):
            said = message(each_us)
            said.kicks, said.kick_us, said.kick_vx_m_s = number, told_us - 20_000, 1.0 * number
            sender = mate_of(said, 2.0)
            assert sender
            sender.overtaken = overtaken
            found += kicks.of_mates([(said, sender)], 1_120_000, 0.3, 0.04)
    assert [kick.velocity_m_s[0] for kick in found] == [5.0, 4.0]
    assert [kick.age_s for kick in found] == pytest.approx([0.06, 0.1])


def test_newest_kick_stays_the_newest() -> None:
    """A mate kicks twice within 40 ms; the second message arrives first, and the first one twice."""
    robot, said = Listener(), []
    for kicks, vy_m_s in ((0, 0.0), (1, -6.0), (2, 3.0)):
        said.append(message(robot.now_us))
        said[-1].kicks, said[-1].kick_us, said[-1].kick_vx_m_s = kicks, robot.now_us - 20_000, 2.0
        said[-1].kick_vy_m_s = vy_m_s
        robot.tick()
    robot.tick([said[0]])
    for told in (said[2], said[1], said[1]):
        assert robot.tick([told]).ball.vy_m_s > 2.0


def told_opponents(robot: Listener) -> list[team_message_t]:
    """Returns the messages of two ticks, not heard yet, about an opponent at (2, 1)."""
    said = []
    for _ in range(2):
        told = message(robot.now_us)
        told.obstacles_capture_us = robot.now_us
        told.obstacles = [obstacle_t(x_m=2.0, y_m=1.0, radius_m=0.25, team=2, covariance_m2=SPREAD_M2)]
        said.append(told)
        robot.tick()
    return said


def test_opponent_in_an_overtaken_message_counts() -> None:
    robot = Listener()
    said = told_opponents(robot)
    assert not robot.tick([said[1]]).opponents
    assert math.isclose(robot.tick([said[0]]).opponents[0].x_m, 2.0, abs_tol=0.1)


def test_message_that_arrives_twice_counts_once() -> None:
    robot = Listener()
    said = told_opponents(robot)
    robot.tick([message(robot.now_us - PERIOD_US)])
    for _ in range(3):
        assert not robot.tick([said[1]]).opponents


def test_newest_message_is_known_after_many_overtaken_ones() -> None:
    robot = Listener()
    said = []
    for _ in range(33):
        said.append(message(robot.now_us))
        robot.tick()
    world = robot.tick([said[-1], *said])
    assert [mate.name for mate in world.mates] == ["cyan2"]


def test_state_of_a_mate_is_that_of_its_newest_message() -> None:
    robot, said = Listener(), []
    for x_m in (-5.0, -4.0):
        said.append(message(robot.now_us))
        said[-1].x_m = x_m
        robot.tick()
    for told in (said[1], said[0]):
        assert robot.tick([told]).mates[0].x_m == pytest.approx(-4.0, abs=0.05)


@pytest.mark.parametrize("contact", [0.0, 1.0])
def test_sightings_of_one_exposure_count_in_any_order(contact: float) -> None:
    """Two mates see a ball that is turned aside at times; one in ten sightings shows another thing."""
    for seed in range(10):
        found = []
        for step in (1, -1):
            rng, tracker, place_m, velocity_m_s = np.random.default_rng(seed), BallTracker(), np.zeros(2), np.ones(2)
            for tick in range(40):
                tracker.advance(PERIOD_US / US_PER_S, 2.0, contact=contact)
                if tick % 10 == 9:
                    velocity_m_s = rng.normal(0.0, 2.5, 2)
                place_m = place_m + velocity_m_s * PERIOD_US / US_PER_S
                seen = []
                for name, deviation_m in (("cyan2", 0.05), ("cyan3", 0.12)):
                    error_m = rng.normal(0.0, 1.0 if rng.random() < 0.1 else deviation_m, 2)
                    seen.append(Sighting(name, False, place_m + error_m, np.eye(2) * deviation_m**2, 0.08))
                for sighting in seen[::step] if tick % 2 else ():
                    tracker.see(sighting)
            found.append(tracker.track.state.tolist())
        assert found[0] == found[1], seed

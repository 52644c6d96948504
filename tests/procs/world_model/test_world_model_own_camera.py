"""The own camera: its pace, exposures that cannot be, crowds, and mates that tell something else."""

import math

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, team_inbox_t, team_message_t
from procs.model.units import US_PER_S
from procs.world_model.frame_pace import FramePace
from procs.world_model.world_model import WorldModel

SPREAD_M2 = ((0.0016, 0.0), (0.0, 0.0016))


def obstacle(x_m: float, y_m: float) -> obstacle_t:
    made = obstacle_t()
    made.x_m, made.y_m, made.radius_m, made.team = x_m, y_m, 0.25, 2
    made.covariance_m2 = [list(row) for row in SPREAD_M2]
    return made


class Watching:
    """World model of a robot that stands in the middle and sees what the test shows."""

    def __init__(self, period_s: float = 0.05) -> None:
        self.bench = Bench(WorldModel, "cyan1/world_model", period_s=period_s)
        self._period_us = round(period_s * US_PER_S)

    @property
    def now_us(self) -> int:
        """Logical time of the next iteration."""
        return self.bench.time_us + self._period_us

    def tick(self) -> None:
        self.bench.port("pose").put(covariance=np.diag((1e-4, 1e-4, 1e-5)).tolist(), localized=True)
        self.bench.port("odometry").put()
        self.bench.port("kicker_state").put(ball_held=False)
        self.bench.iterate()
        self.world = self.bench.port("world_model").sent[-1]

    def see_robots(self, *places_m: tuple[float, float], age_s: float = 0.035) -> None:
        seen = [obstacle(*place) for place in places_m]
        self.bench.port("obstacle_percepts").put(capture_us=self.now_us - round(age_s * US_PER_S), obstacles=seen)

    def see_ball(self, x_m: float, y_m: float, z_m: float = 0.0, age_s: float = 0.035) -> None:
        capture_us = max(1, self.now_us - round(age_s * US_PER_S))
        self.bench.port("ball_percept").put(
            capture_us=capture_us, visible=True, x_m=x_m, y_m=y_m, z_m=z_m, covariance_m2=SPREAD_M2
        )

    def hear_of_held_ball(self, x_m: float, y_m: float) -> None:
        """A mate at this place, which looks along x, tells that it has the ball in its mouth."""
        said = team_message_t()
        said.robot, said.number, said.localized, said.ball_held = "cyan2", 2, True, True
        said.x_m, said.y_m, said.pose_covariance = x_m, y_m, np.diag((4e-4, 4e-4, 1e-4)).tolist()
        said.header.time_us = self.now_us - 40_000
        inbox = team_inbox_t()
        inbox.messages = [said]
        self.bench.port("team_inbox").put(inbox)


@pytest.mark.parametrize(
    ("period_s", "every", "latency_s"),
    [(0.05, 2, 0.035), (0.05, 2, 0.12), (0.05, 4, 0.035), (0.1, 2, 0.16), (0.02, 10, 0.2)],
)
def test_slow_cameras_show_opponents_too(period_s: float, every: int, latency_s: float) -> None:
    robot = Watching(period_s)
    known = []
    for tick in range(round(3.0 / period_s)):
        if tick % every == 0:
            robot.see_robots((2.0, 1.0), age_s=latency_s)
        robot.tick()
        known.append(len(robot.world.opponents))
    assert set(known[len(known) // 3 :]) == {1}


def test_a_ghost_of_a_slow_camera_is_forgotten() -> None:
    robot = Watching()
    for tick in range(60):
        if tick % 4 == 0:
            robot.see_robots(*([(2.0, 1.0), (-3.0, 0.0)] if tick == 20 else [(2.0, 1.0)]))
        robot.tick()
        assert len(robot.world.opponents) <= 1
    assert len(robot.world.opponents) == 1


@pytest.mark.parametrize(
    ("exposed_s", "next_s"),
    [
        ([], 0.0),
        ([1.0], 0.0),
        ([1.0, 1.1], 0.14),
        ([1.0, 1.1, 1.4, 1.5], 0.14),
        ([1.0, 1.1, 1.0], 0.0),
        ([1.0, 1.1, 9.0], 0.0),
    ],
    ids=["none", "one", "two", "a frame was lost", "an older frame", "after a long silence"],
)
def test_the_pace_is_that_of_successive_frames(exposed_s: list[float], next_s: float) -> None:
    pace = FramePace()
    for each_s in exposed_s:
        pace.note(round(each_s * US_PER_S))
    assert pace.next_s == pytest.approx(next_s)


@pytest.mark.parametrize("ahead_us", [1, 10 * US_PER_S, (1 << 62) - US_PER_S * 1000])
def test_exposures_still_to_come_make_no_opponent_last(ahead_us: int) -> None:
    robot = Watching()
    for tick in range(60):
        if tick < 20:
            robot.see_robots((2.0, 0.0))
        elif tick == 20:
            robot.see_robots((2.1, 0.0), (0.0, 4.0), age_s=-ahead_us / US_PER_S)
        robot.tick()
        assert all(one.age_s >= 0.0 for one in robot.world.opponents)
    assert robot.world.opponents == []


@pytest.mark.parametrize(
    ("period_s", "every", "latency_s"),
    [(0.05, 2, 0.035), (0.04, 3, 0.15), (0.04, 5, 0.035), (0.04, 5, 0.15), (0.04, 7, 0.035), (0.1, 3, 0.035)],
)
def test_a_mates_dirty_barrier_does_not_move_the_seen_ball(period_s: float, every: int, latency_s: float) -> None:
    robot = Watching(period_s)
    for tick in range(round(3.0 / period_s)):
        if tick % every == 0:
            robot.see_ball(2.0, 0.0, age_s=latency_s)
        if tick % 2 == 0:
            robot.hear_of_held_ball(-9.0, 5.0)
        robot.tick()
        if tick >= 3 * every:
            assert math.dist((robot.world.ball.x_m, robot.world.ball.y_m), (2.0, 0.0)) < 0.2
    assert robot.world.ball_holder == ""


def test_an_old_sight_contradicts_no_barrier() -> None:
    """The camera has shown the ball elsewhere, but is silent for longer than half a second."""
    robot = Watching()
    for tick in range(40):
        if tick < 20 and tick % 4 == 0:
            robot.see_ball(2.0, 0.0)
        if tick >= 30:
            robot.hear_of_held_ball(-7.0, 4.0)
        robot.tick()
    assert robot.world.ball_holder == "cyan2"


@pytest.mark.parametrize(("period_s", "every"), [(0.04, 2), (0.04, 8), (0.04, 10), (0.1, 5)])
def test_two_frames_of_a_slow_camera_show_that_the_ball_moved(period_s: float, every: int) -> None:
    """Nothing can have touched the ball, which lies 2 m further away from the 20th frame on."""
    robot = Watching(period_s)
    for tick in range(22 * every):
        if tick % every == 0:
            robot.see_ball(2.0 if tick < 20 * every else 4.0, 0.0)
        robot.tick()
    assert robot.world.ball.x_m == pytest.approx(4.0, abs=0.1)


def test_a_mate_holds_a_ball_that_is_seen_in_its_mouth() -> None:
    robot = Watching()
    for tick in range(40):
        if tick % 2 == 0:
            robot.see_ball(2.3, 0.1)
            robot.hear_of_held_ball(2.0, 0.0)
        robot.tick()
    assert robot.world.ball_holder == "cyan2"


def test_a_mate_holds_a_ball_that_the_own_camera_misses() -> None:
    robot = Watching()
    for tick in range(40):
        if tick < 10 and tick % 2 == 0:
            robot.see_ball(4.0, 0.0)
        if tick >= 20:
            robot.hear_of_held_ball(-5.0, 3.0)
        robot.tick()
    assert robot.world.ball_holder == "cyan2"
    assert robot.world.ball.x_m < -4.0


def test_a_crowd_costs_no_more_than_its_nearest_fifty() -> None:
    robot = Watching()
    crowd = [(0.6 * column - 5.0, 0.6 * row - 3.0) for row in range(10) for column in range(300)]
    for _ in range(4):
        robot.see_robots(*crowd)
        robot.tick()
    assert 0 < len(robot.world.opponents) <= 50


@pytest.mark.parametrize(("period_s", "every"), [(0.04, 2), (0.02, 4), (0.01, 8), (0.1, 1), (0.05, 2), (0.02, 2)])
def test_messages_go_with_frames_at_every_tick_rate(period_s: float, every: int) -> None:
    """A camera of 10, 12.5 or 25 frames a second; the message has the sighting of its own tick."""
    robot = Watching(period_s=period_s)
    for tick in range(round(2.0 / period_s)):
        if tick % every == 0:
            robot.see_ball(2.0, 1.0)
        robot.tick()
    told = robot.bench.port("team_message").sent[2:]
    assert all(message.ball_visible for message in told)
    assert {message.header.time_us - message.ball_capture_us for message in told} == {35_000}
    between_s = (told[-1].header.time_us - told[0].header.time_us) / (len(told) - 1) / 1e6
    assert 0.079 < between_s < 0.121, "0.1 s, by the nearest frame"


def test_impossible_height_is_not_told_to_the_team() -> None:
    robot = Watching()
    for z_m in (0.2, math.inf):
        for _ in range(6):
            robot.see_ball(2.0, 0.0, z_m)
            robot.tick()
    assert all(math.isfinite(sent.ball_z_m) for sent in robot.bench.port("team_message").sent)


@pytest.mark.parametrize(("age_s", "known"), [(-0.015, True), (-0.03, False)])
def test_clock_of_the_camera_may_be_a_little_ahead(age_s: float, known: bool) -> None:
    robot = Watching()
    for _ in range(10):
        robot.see_ball(2.0, 0.0, age_s=age_s)
        robot.see_robots((0.0, 3.0), age_s=age_s)
        robot.tick()
    assert robot.world.ball.known == known
    assert len(robot.world.opponents) == known
    assert any(sent.ball_visible for sent in robot.bench.port("team_message").sent) == known


def test_frame_that_comes_twice_counts_once() -> None:
    """A driver publishes its newest frame again: what only that frame shows is neither the ball nor an opponent."""
    robot = Watching()
    for _ in range(20):
        robot.see_ball(2.0, 0.0)
        robot.tick()
    for age_s in (0.035, 0.085):
        robot.see_ball(-3.0, 0.0, age_s=age_s)
        robot.see_robots((0.0, 3.0), age_s=age_s)
        robot.tick()
    assert robot.world.ball.x_m == pytest.approx(2.0, abs=0.05)
    assert robot.world.opponents == []


def test_frame_that_comes_twice_is_no_more_certain() -> None:
    claims_m2 = []
    for times in (1, 4):
        robot = Watching()
        for tick in range(40):
            if tick % 4 < times:
                robot.see_ball(2.0, 0.0, age_s=0.035 + 0.05 * (tick % 4))
            robot.tick()
        claims_m2.append(robot.world.ball.covariance[0][0])
    assert claims_m2[1] == pytest.approx(claims_m2[0])


@pytest.mark.parametrize(("z_m", "age_s"), [(math.nan, 0.035), (50.0, 0.035), (0.0, -0.06), (0.0, 0.7)])
def test_team_hears_no_sighting_that_the_robot_rejects(z_m: float, age_s: float) -> None:
    """A ball in the clouds, or an exposure that is still to come or too old."""
    robot = Watching()
    for _ in range(20):
        robot.tick()
    for _ in range(6):
        robot.see_ball(2.0, 0.0, z_m, age_s)
        robot.tick()
    assert not robot.world.ball.known
    assert not any(sent.ball_visible for sent in robot.bench.port("team_message").sent)


def test_silent_wheels_do_not_move_the_robot_for_ever() -> None:
    robot = Watching()
    robot.tick()
    for tick in range(40):
        if tick < 20:
            robot.bench.port("odometry").put(vx_m_s=2.0)
        robot.bench.port("pose").put(x_m=0.1 * min(tick, 20), covariance=np.eye(3).tolist(), localized=True)
        robot.bench.iterate()
    world = robot.bench.port("world_model").sent
    assert world[20].vx_m_s == pytest.approx(2.0)
    assert world[-1].vx_m_s == 0.0

"""Mates tell each other sightings, kicks, a caught ball and opponents by radio; a sighting counts from its exposure."""

import math

import numpy as np
import pytest

from lcmtypes.soccer import obstacle_t, team_message_t
from procs.world_model.team import Mate, Places
from tests.procs.world_model.team_on_bench import PERIOD_S, Robot, decoded, team


def test_robot_sends_its_own_sighting_ten_times_a_second() -> None:
    pair = team()
    told: list[team_message_t] = []
    for _ in range(20):
        robot = pair.robots[1]
        pair.tick(np.array((0.0, 0.0)), blind=("cyan2",))
        told += [m for r in pair.robots[:1] for i in r.bench.port("team_inbox").waiting for m in decoded(r, i)]
    assert pair.robots[1].world.ball.known, "told by the mates"
    of_second = [message for message in told if message.robot == robot.name]
    assert len(of_second) == 10
    assert not any(message.ball_visible for message in of_second)
    of_third = [message for message in told if message.robot == "cyan3"]
    assert all(message.ball_visible for message in of_third)
    assert (of_third[-1].ball_x_m, of_third[-1].ball_y_m) == pytest.approx((0.0, 0.0), abs=0.6)
    assert {message.role for message in told} == {"supporter"}


def test_opponent_that_only_a_mate_sees_is_known() -> None:
    pair = team()
    hidden = np.array((6.0, -3.0))
    for _ in range(20):
        pair.tick(None, others_m=(hidden,))
    assert np.hypot(*(pair.robots[0].pose[:2] - hidden)) > 8, "too far to be seen well enough"
    assert any(math.hypot(one.x_m - 6.0, one.y_m + 3.0) < 0.3 for one in pair.robots[0].world.opponents)


def test_unlocalized_robot_listens_but_shares_no_sighting() -> None:
    pair = team()
    lost = pair.robots[0]
    lost.localized = False
    lost.pose_error = np.array((5.0, 5.0, 1.0))
    for _ in range(20):
        pair.tick(np.array((1.0, 1.0)))
    assert not lost.world.localized
    assert (lost.world.ball.x_m, lost.world.ball.y_m) == pytest.approx((1.0, 1.0), abs=0.1)
    other = pair.robots[1].world
    assert "cyan1" not in [mate.name for mate in other.mates]
    assert other.ball.observers == 3


@pytest.mark.parametrize("parity", [0, 1])
def test_frames_of_every_second_tick_reach_the_message(parity: int) -> None:
    """Cameras give frames in even or in odd ticks, and messages are sent in every second tick."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for tick in range(20):
        robot.sense(np.array((2.0, 1.0)), [np.array((0.0, 2.0))])
        if tick % 2 != parity:
            for sensor in ("ball_percept", "obstacle_percepts"):
                robot.bench.port(sensor).waiting.clear()
        robot.bench.iterate()
    told = robot.bench.port("team_message").sent
    assert len(told) == 10
    assert sum(message.ball_visible for message in told) >= 9
    assert sum(len(message.obstacles) == 1 for message in told) >= 9
    ages_us = [message.header.time_us - message.ball_capture_us for message in told if message.ball_visible]
    assert set(ages_us) <= {0, round(PERIOD_S * 1e6)}
    assert set(ages_us[2:]) == {0}, "messages keep the camera's pace"


def test_message_out_of_step_with_the_camera_finds_its_pace() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for tick in range(20):
        robot.sense(np.array((2.0, 1.0)), [])
        if tick % 2:
            robot.bench.port("ball_percept").waiting.clear()
        if tick == 9:  # a kick is told at once, between two frames
            robot.bench.port("kicker_state").put(ball_held=False, kicks=1, kick_speed_m_s=8.0)
        robot.bench.iterate()
    told = robot.bench.port("team_message").sent
    assert {message.header.time_us - message.ball_capture_us for message in told[-3:]} == {0}


def test_mates_sight_counts_from_its_exposure() -> None:
    """A mate saw a fast ball 0.1 s before its message: without the age it is half a metre behind."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(12):
        now_us = robot.bench.time_us + round(PERIOD_S * 1e6)
        message = team_message_t()
        message.robot, message.localized, message.ball_visible = "cyan2", True, True
        message.header.time_us, message.ball_capture_us = now_us, max(1, now_us - 100_000)
        message.ball_x_m = -4.0 + 5.0 * message.ball_capture_us / 1e6
        message.ball_covariance_m2 = [[1e-4, 0.0], [0.0, 1e-4]]
        robot.sense(None, [])
        robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
    true_x_m = -4.0 + 5.0 * robot.bench.time_us / 1e6
    assert robot.world.ball.x_m == pytest.approx(true_x_m, abs=0.15)


def test_opponent_that_a_mate_saw_has_driven_on_since() -> None:
    """A mate saw an opponent at 3 m/s 0.1 s before its message: without the age it is 0.3 m behind."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(20):
        now_us = robot.bench.time_us + round(PERIOD_S * 1e6)
        message, opponent = team_message_t(), obstacle_t()
        message.robot, message.localized = "cyan2", True
        message.header.time_us, message.obstacles_capture_us = now_us, max(1, now_us - 100_000)
        opponent.x_m, opponent.y_m = -4.0 + 3.0 * message.obstacles_capture_us / 1e6, 3.0
        opponent.covariance_m2 = [[1e-4, 0.0], [0.0, 1e-4]]
        message.obstacles = [opponent]
        robot.sense(None, [])
        robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
    (known,) = robot.world.opponents
    assert known.x_m == pytest.approx(-4.0 + 3.0 * robot.bench.time_us / 1e6, abs=0.1)


def test_mates_covariance_is_the_one_that_it_states() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    deviations_m = []
    for claimed_m in (0.01, 0.5):
        for _ in range(3):
            message = team_message_t()
            message.robot, message.localized = "cyan2", True
            message.header.time_us = robot.bench.time_us
            message.pose_covariance = np.diag((claimed_m**2, claimed_m**2, 0.01)).tolist()
            robot.bench.port("team_inbox").put(messages=[message])
            robot.bench.iterate()
        deviations_m.append(math.sqrt(robot.world.mates[0].covariance_m2[0][0]))
    assert deviations_m[0] < 0.1
    assert deviations_m[1] > 0.4


@pytest.mark.parametrize("passed_s", [0.04, 0.1, 0.3, 0.5])
def test_claim_about_a_mate_covers_what_it_does_meanwhile(passed_s: float) -> None:
    """A mate told its place with a deviation of 2 cm, and has since driven on with other accelerations."""
    rng, insides, told_m2 = np.random.default_rng(5), [], 0.02**2
    velocity_m_s = np.array((1.5, -0.5))
    for _ in range(400):
        error_m, pushed_m_s2 = rng.normal(0.0, 0.02, 2), rng.normal(0.0, 1.5, 2)
        true_m = velocity_m_s * passed_s + pushed_m_s2 * passed_s**2 / 2
        mate = Mate("cyan3", "", 10.0, error_m, 0.0, velocity_m_s, True, np.eye(2) * told_m2)
        places_m, covariances_m2 = Places([mate]).at(10.0 + passed_s)
        missed_m = places_m[0] - true_m
        insides.append(missed_m @ np.linalg.solve(covariances_m2[0], missed_m) < 5.99)
    assert np.mean(insides) > 0.90
    if passed_s <= 0.1:
        assert np.mean(insides) < 0.998, "a claim that is much too wide tells little"


def test_ball_in_the_mouth_of_a_turning_mate_turns_with_it() -> None:
    """A mate turns at 3 rad/s with the ball; its messages come every 0.1 s, and no camera sees the ball."""
    robot, turning_rad_s = Robot("cyan1", (0.0, 0.0, 0.0), seed=1), 3.0
    errors_m_s = []
    for tick in range(14):
        heading_rad = turning_rad_s * (robot.bench.time_us + 50_000) / 1e6
        robot.sense(None, [])
        if tick % 2:
            message = team_message_t()
            message.robot, message.localized, message.ball_held = "cyan2", True, True
            message.header.time_us = robot.bench.time_us + 50_000
            message.x_m, message.heading_rad = 3.0, math.remainder(heading_rad, math.tau)
            message.pose_covariance = np.diag((1e-4, 1e-4, 1e-4)).tolist()
            robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
        if tick > 4:
            speed_m_s, ball = 0.33 * turning_rad_s, robot.world.ball
            true_m_s = -speed_m_s * math.sin(heading_rad), speed_m_s * math.cos(heading_rad)
            errors_m_s.append(math.dist((ball.vx_m_s, ball.vy_m_s), true_m_s))
    assert max(errors_m_s) < 0.3


def test_ball_that_was_caught_or_lost_is_told_at_once() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    told = robot.bench.port("team_message").sent
    for tick in range(20):
        held = 7 <= tick < 12
        robot.sense(np.array((0.33, 0.0)), [], held=held)
        robot.bench.iterate()
        if tick in (7, 12):
            assert told[-1].header.time_us == robot.bench.time_us
            assert told[-1].ball_held == held


def test_kick_is_told_at_once_and_a_second_time() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(5):
        robot.sense(np.array((0.33, 0.0)), [], held=True)
        robot.bench.iterate()
    told = robot.bench.port("team_message").sent
    while told[-1].header.time_us != robot.bench.time_us:  # a kick in the tick after a message
        robot.sense(np.array((0.33, 0.0)), [], held=True)
        robot.bench.iterate()
    before = len(told)
    robot.sense(np.array((0.33, 0.0)), [])
    robot.bench.port("kicker_state").put(ball_held=False, kicks=1, kick_speed_m_s=8.0)
    robot.bench.iterate()
    assert len(told) == before + 1
    assert (told[-1].kicks, told[-1].kick_us) == (1, robot.bench.time_us - 25_000)  # in the middle of the tick
    kick_us = told[-1].kick_us
    for expected in (2, 2):
        robot.sense(np.array((0.7, 0.0)), [])
        robot.bench.port("kicker_state").put(ball_held=False, kicks=1, kick_speed_m_s=8.0)
        robot.bench.iterate()
        assert len(told) == before + expected
        assert (told[-1].kicks, told[-1].kick_us) == (1, kick_us)


def test_kick_counts_although_the_mouth_still_saw_the_ball() -> None:
    """The ball left late in a tick: in its message the mate reports the kick and a ball in its mouth."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for tick in range(12):
        now_us = robot.bench.time_us + round(PERIOD_S * 1e6)
        message = team_message_t()
        message.robot, message.localized, message.ball_held = "cyan2", True, tick < 11
        message.header.time_us, message.x_m = now_us, 2.0
        if tick >= 10:
            message.kicks, message.kick_us = 1, 10 * round(PERIOD_S * 1e6) + 25_000
            message.kick_vx_m_s = 6.0
        robot.sense(None, [])
        robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
        if tick == 10:
            assert robot.world.ball.vx_m_s == pytest.approx(6.0, abs=0.3)


def test_robot_of_the_other_team_is_no_mate() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for name in ("cyan2", "magenta2", "stranger"):
        robot.sense(None, [])
        robot.bench.port("team_inbox").put(messages=[team_message_t(robot=name, localized=True, x_m=1.0)])
        robot.bench.iterate()
    assert [mate.name for mate in robot.world.mates] == ["cyan2", "stranger"]


@pytest.mark.parametrize(("name", "x_m"), [("", 1.0), ("cyan2", 300.0), ("cyan2", -14.0)])
def test_mate_without_a_name_or_behind_the_walls_is_left_out(name: str, x_m: float) -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    wrong = team_message_t(robot=name, localized=True, x_m=x_m, ball_visible=True, ball_x_m=2.0)
    for message in (wrong, wrong, wrong, team_message_t(robot="cyan3", localized=True)):
        robot.sense(None, [])
        message.header.time_us = robot.bench.time_us
        robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
    assert [mate.name for mate in robot.world.mates] == ["cyan3"]
    assert not robot.world.ball.known


@pytest.mark.parametrize(("apart_us", "turned_rad"), [(1, 0.01), (100_000, 3.1)])
def test_mate_whose_heading_jumps_does_not_turn(apart_us: int, turned_rad: float) -> None:
    """The mate's pose or clock was corrected; the ball in its mouth rests."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for heading_rad, ago_us in ((0.0, apart_us), (turned_rad, 0)):
        robot.sense(None, [])
        message = team_message_t(robot="cyan2", localized=True, ball_held=True, x_m=3.0, heading_rad=heading_rad)
        message.header.time_us = 200_000 - ago_us
        message.pose_covariance = np.diag((1e-4, 1e-4, 1e-4)).tolist()
        while robot.bench.time_us < 150_000:
            robot.bench.iterate()
        robot.bench.port("team_inbox").put(messages=[message])
        robot.bench.iterate()
    assert robot.world.ball.known
    assert math.hypot(robot.world.ball.vx_m_s, robot.world.ball.vy_m_s) < 0.1

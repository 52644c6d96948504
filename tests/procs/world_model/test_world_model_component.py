"""World models of a team on the bench: frames, sources, honesty, opponents, impossible input."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

from lcmtypes.soccer import ball_candidate_t, obstacle_t, robot_estimate_t, team_message_t
from procs.world_model.seen import Seen
from tests.procs.world_model.team_on_bench import PERIOD_S, Floats, Robot, team


def test_ball_and_opponent_are_placed_from_camera_and_pose() -> None:
    robot = Robot("cyan1", (2.0, 1.0, math.pi / 2), seed=1)
    for _ in range(20):
        robot.sense(np.array((2.0, 3.0)), [np.array((0.0, 1.0))])
        robot.bench.iterate()
    world = robot.world
    assert world.localized
    assert world.ball.known
    assert (world.ball.x_m, world.ball.y_m) == pytest.approx((2.0, 3.0), abs=0.06)
    assert world.ball.observers == 1
    assert len(world.opponents) == 1
    assert (world.opponents[0].x_m, world.opponents[0].y_m) == pytest.approx((0.0, 1.0), abs=0.08)


def test_opponents_contain_neither_mates_nor_oneself() -> None:
    four = team()
    four.robots[3].role = "goalkeeper"
    opponents = (np.array((0.0, -3.0)), np.array((-2.0, 1.05)))
    for _ in range(40):
        four.tick(None, others_m=opponents)
    for robot in four.robots:
        mates = [other for other in four.robots if other is not robot]
        world = robot.world
        assert [mate.name for mate in world.mates] == [mate.name for mate in mates]
        assert [mate.role for mate in world.mates] == [mate.role for mate in mates]
        said = [mate.agreement for mate in world.mates]
        told_passes = [(each.receiver, each.x_m, each.y_m) for each in said]
        assert told_passes == [(f"for {mate.name}", 1.5, -2.0) for mate in mates]
        for told, mate in zip(world.mates, mates, strict=True):
            assert (told.x_m, told.y_m) == pytest.approx(mate.pose[:2].tolist(), abs=0.08)
        places = np.array([(one.x_m, one.y_m) for one in world.opponents])
        assert len(places) == 2, "one of them touches a mate"
        for opponent in opponents:
            assert np.hypot(*(places - opponent).T).min() < 0.25


def places(estimates: Iterable[robot_estimate_t]) -> list[tuple[float, float]]:
    return [(one.x_m, one.y_m) for one in estimates]


def test_robot_in_the_own_colour_is_a_silent_mate() -> None:
    """A mate whose radio is broken, or that is lost, tells no place, but shows its marker."""
    robot = Robot("cyan1", (2.0, 1.0, math.pi / 2), seed=1)
    for _ in range(20):
        robot.sense(None, [np.array((0.0, 1.0)), np.array((2.0, 3.0))], teams=(1, 2))
        robot.bench.iterate()
    assert places(robot.world.opponents) == [pytest.approx((2.0, 3.0), abs=0.08)]
    assert places(robot.world.silent_mates) == [pytest.approx((0.0, 1.0), abs=0.08)]


def test_mate_that_tells_its_place_is_not_silent() -> None:
    four = team()
    own, mate = four.robots[:2]
    for localized in (False, True):
        mate.localized = localized
        for _ in range(20):
            four.tick(None, teams=(1, 1, 1))
        assert [one.name for one in own.world.mates].count(mate.name) == localized
        assert len(own.world.silent_mates) == (not localized)


def test_held_ball_is_in_the_mouth_and_in_the_message() -> None:
    robot = Robot("cyan1", (1.0, -1.0, -math.pi / 2), seed=1)
    for _ in range(4):
        robot.sense(None, [], held=True)
        robot.bench.iterate()
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((1.0, -1.33), abs=0.05)
    assert robot.bench.port("team_message").sent[-1].ball_held


def test_ball_is_not_held_for_ever_by_a_silent_kicker() -> None:
    """The kicker's process ends while the ball is in the mouth; then the ball is carried away."""
    robot = Robot("cyan1", (1.0, -1.0, 0.0), seed=1)
    for tick in range(60):
        robot.sense(np.array((4.0, -1.0)) if tick >= 20 else None, [], held=True)
        if tick < 20:
            robot.bench.iterate()
        else:
            robot.bench.port("kicker_state").waiting.clear()
            robot.bench.iterate()
    assert robot.world.ball_holder == ""
    assert robot.world.ball.x_m == pytest.approx(4.0, abs=0.1)
    assert not robot.bench.port("team_message").sent[-1].ball_held


def test_robot_without_an_agent_tells_that_it_does_not_play() -> None:
    robot = Robot("cyan1", (1.0, -1.0, 0.0), seed=1)
    robot.sense(None, [])
    told = []
    for _ in range(60):
        robot.bench.iterate()
        told = [message.role for message in robot.bench.port("team_message").sent]
    assert told[0] == told[8] == "supporter"
    assert told[-1] == "absent"


def test_silence_makes_the_robot_forget_everything_in_time() -> None:
    four = team()
    for _ in range(20):
        four.tick(np.array((1.0, 1.0)), others_m=(np.array((0.0, -3.0)),))
    robot = four.robots[0]
    assert robot.world.ball.known
    robot.bench.iterate(110)
    assert not robot.world.localized
    assert not robot.world.ball.known
    assert robot.world.opponents == []
    assert robot.world.mates == []


def ball_errors(loss: float, blind: bool, seeds: int = 6) -> tuple[float, list[float]]:
    """Returns the root mean square of the ball's error: with radio (all robots together), and of each robot alone."""

    def run(seed: int, loss: float) -> Floats:
        four = team(seed, loss=loss)
        errors = []
        ball_m, velocity_m_s = np.array((-1.0, 2.0)), np.array((1.2, -0.8))
        for frame in range(60):
            velocity_m_s = velocity_m_s * max(0.0, 1 - 0.4 * PERIOD_S / float(np.hypot(*velocity_m_s)))
            ball_m = ball_m + velocity_m_s * PERIOD_S
            four.tick(ball_m, blind=("cyan4",) if blind else ())
            if frame >= 15:
                errors.append(
                    [
                        math.hypot(r.world.ball.x_m - ball_m[0], r.world.ball.y_m - ball_m[1])
                        if r.world.ball.known
                        else math.nan
                        for r in four.robots
                    ]
                )
        return np.array(errors)

    fused = np.concatenate([run(seed, loss) for seed in range(seeds)])
    alone = np.concatenate([run(seed, 1.0) for seed in range(seeds)])
    return float(np.sqrt(np.nanmean(fused**2))), np.sqrt(np.nanmean(alone**2, axis=0)).tolist()


@pytest.mark.slow
def test_team_ball_beats_median_and_matches_best_robot() -> None:
    fused, alone = ball_errors(loss=0.03, blind=False)
    assert fused <= 0.5 * np.median(alone)
    assert fused <= 1.1 * min(alone)


@pytest.mark.slow
def test_without_any_radio_each_robot_relies_on_itself() -> None:
    fused, alone = ball_errors(loss=1.0, blind=False, seeds=1)
    assert fused == pytest.approx(np.sqrt(np.mean(np.square(alone))))


def ball_nees(robots: int, runs: int = 20) -> float:
    """Returns the mean normalised squared position error (2 if consistent) of a ball at rest."""
    values = []
    for seed in range(runs):
        four = team(1000 + seed)
        four.robots = four.robots[:robots]
        ball_m = np.array((0.5, 0.5))
        for _ in range(40):
            four.tick(ball_m)
        for robot in four.robots:
            ball = robot.world.ball
            error = np.array((ball.x_m, ball.y_m)) - ball_m
            values.append(float(error @ np.linalg.solve(np.array(ball.covariance)[:2, :2], error)))
    return float(np.mean(values))


@pytest.mark.parametrize("robots", [1, 4])
@pytest.mark.slow
def test_balls_covariance_covers_the_error_of_the_own_pose(robots: int) -> None:
    assert 0.5 < ball_nees(robots) < 3.5


def test_same_messages_give_the_same_world() -> None:
    def run() -> list[bytes]:
        four = team(loss=0.1, delay_jitter_s=0.1)
        for _ in range(30):
            four.tick(np.array((1.0, 1.0)), others_m=(np.array((0.0, -3.0)),))
        return [sent.encode() for robot in four.robots for sent in robot.bench.port("world_model").sent]

    assert run() == run()


@pytest.mark.parametrize("value", [math.nan, math.inf, -1e300])
def test_impossible_values_are_ignored(value: float) -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(10):
        robot.sense(np.array((2.0, 0.0)), [np.array((0.0, 2.0))])
        robot.bench.iterate()
    obstacle = obstacle_t()
    obstacle.x_m = obstacle.radius_m = value
    said = team_message_t()
    said.robot, said.localized, said.ball_visible, said.obstacles = "cyan2", True, True, [obstacle]
    said.x_m = value
    told = team_message_t()
    told.robot, told.localized, told.ball_visible, told.obstacles = "cyan3", True, True, [obstacle]
    told.ball_x_m = value
    for broken in ({"x_m": value}, {"covariance": [[value] * 3] * 3}, {}):
        robot.bench.port("pose").put(**{"localized": True, **broken})
        robot.bench.port("odometry").put(vx_m_s=value, omega_rad_s=value)
        robot.bench.port("ball_percept").put(visible=True, x_m=value, covariance_m2=[[value, 0.0], [0.0, -1.0]])
        robot.bench.port("obstacle_percepts").put(obstacles=[obstacle])
        robot.bench.port("kicker_state").put(ball_held=False, kicks=5)
        robot.bench.port("team_inbox").put(messages=[said, told])
        robot.bench.iterate()
    for _ in range(5):
        robot.sense(np.array((2.0, 0.0)), [np.array((0.0, 2.0))])
        robot.bench.iterate()
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((2.0, 0.0), abs=0.1)
    assert len(robot.world.opponents) == 1
    assert [mate.name for mate in robot.world.mates] == ["cyan3"]


@pytest.mark.parametrize(("x_m", "y_m"), [(14.5, 0.0), (0.0, -300.0)])
def test_robot_far_outside_the_walls_is_lost(x_m: float, y_m: float) -> None:
    """Its sightings would be wrong, too: a ball that it sees towards the field would seem to be inside."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(5):
        robot.sense(np.array((2.0, 0.0)), [])
        robot.bench.port("pose").put(x_m=x_m, y_m=y_m, heading_rad=3.0, covariance=np.eye(3).tolist(), localized=True)
        robot.bench.iterate()
        assert not robot.world.localized
        assert not robot.world.ball.known
    assert not any(told.localized or told.ball_visible for told in robot.bench.port("team_message").sent)
    robot.sense(np.array((2.0, 0.0)), [])
    robot.bench.iterate()
    assert robot.world.localized
    assert robot.world.ball.known


def test_sighting_without_any_error_does_not_break_the_filter() -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(10):
        robot.bench.port("pose").put(localized=True)
        robot.bench.port("ball_percept").put(visible=True, x_m=2.0)
        robot.bench.port("obstacle_percepts").put(obstacles=[obstacle_t(), obstacle_t()])
        robot.bench.iterate()
    assert robot.world.ball.x_m == pytest.approx(2.0, abs=1e-3)


def test_sightings_with_impossible_covariances_are_left_out() -> None:
    spreads = np.array([np.eye(2), -np.eye(2), [[1.0, 2.0], [2.0, 1.0]], np.zeros((2, 2))])
    seen = Seen.of(np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]]), spreads, np.zeros(4))
    assert seen.positions_m[:, 0].tolist() == [1.0, 4.0]
    assert (np.linalg.eigvalsh(seen.covariances_m2) > 0).all()


def damaged(part: str, covariance: list[list[float]]) -> Robot:
    """Returns a robot in one of whose ticks a message stated such a covariance; then it saw the ball for a second."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    port = robot.bench.port
    for tick in range(45):
        robot.sense(np.array((2.0, 0.0)), [])
        if tick == 25:
            mate = team_message_t(robot="cyan2", localized=True, ball_visible=True, ball_x_m=2.0)
            mate.header.time_us = robot.bench.time_us
            if part == "pose":
                port("pose").put(localized=True, covariance=covariance)
            elif part == "ball":
                port("ball_percept").put(visible=True, x_m=2.0, covariance_m2=covariance)
            elif part == "pose of a mate":
                mate.pose_covariance = covariance
            else:
                mate.ball_covariance_m2 = covariance
            port("team_inbox").put(messages=[mate])
        robot.bench.iterate()
        assert np.isfinite(robot.world.ball.covariance).all(), f"tick {tick}"
    return robot


@pytest.mark.parametrize(
    "covariance", [[[1e-3, -1.0], [0.0, 1e-3]], [[1e-3, 0.01], [0.0, 1e-3]], [[-1.0, 0.0], [0.0, 1e-3]]]
)
@pytest.mark.parametrize("part", ["ball", "ball of a mate", "pose", "pose of a mate"])
def test_ball_survives_what_is_no_covariance(part: str, covariance: list[list[float]]) -> None:
    if part.startswith("pose"):
        covariance = [[*covariance[0], 0.0], [*covariance[1], 0.0], [0.0, 0.0, 1e-3]]
    world = damaged(part, covariance).world
    assert (world.ball.x_m, world.ball.y_m) == pytest.approx((2.0, 0.0), abs=0.1)
    assert [mate.name for mate in world.mates] == ([] if part == "pose of a mate" else ["cyan2"])


def test_slipping_wheels_do_not_turn_what_the_robot_sees() -> None:
    """In a scrum the wheels turn at 3 rad/s; the gyro, and so the pose, knows that the robot does not."""
    robot, ball_m = Robot("cyan1", (0.0, 0.0, 0.0), seed=1), np.array((4.0, 0.0))
    for _ in range(20):
        robot.sense(ball_m, [])
        robot.bench.port("ball_percept").waiting.clear()
        robot.bench.port("odometry").put(omega_rad_s=3.0)
        captured_us = max(1, robot.bench.time_us + round(PERIOD_S * 1e6) - 35_000)
        covariance_m2 = [[1e-4, 0.0], [0.0, 1e-4]]
        robot.bench.port("ball_percept").put(
            visible=True, x_m=4.0, confidence=1.0, covariance_m2=covariance_m2, capture_us=captured_us
        )
        robot.bench.iterate()
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((4.0, 0.0), abs=0.1), "0.4 m with the wheels"


def followed_ball(**settings: bool) -> tuple[float, float]:
    """Returns place and speed, along y, of a ball at 2 m/s whose frames are 50 ms old; it truly is at y = 2."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1, **settings)
    for tick in range(-40, 1):
        robot.sense(np.array((2.0, 2.0 + (tick - 1) * 0.1)), [])
        percept = robot.bench.port("ball_percept")
        (x_m, y_m), spread = robot.in_frame(np.array((2.0, 2.0 + (tick - 1) * 0.1)))
        percept.put(
            visible=True, x_m=x_m, y_m=y_m, covariance_m2=spread.tolist(), capture_us=max(1, robot.bench.time_us)
        )
        robot.bench.iterate()
    return robot.world.ball.y_m, robot.world.ball.vy_m_s


def test_settings_show_what_exposure_times_and_velocity_bring() -> None:
    y_m, vy_m_s = followed_ball()
    assert y_m == pytest.approx(2.0, abs=0.1)
    assert vy_m_s == pytest.approx(2.0, abs=0.4)
    behind_m = y_m - followed_ball(use_capture_times=False)[0]
    assert behind_m == pytest.approx(0.05 * vy_m_s, abs=0.03)
    assert followed_ball(use_ball_velocity=False) == (y_m, 0.0)


NEAR = [[1e-4, 0.0], [0.0, 1e-4]]


@pytest.mark.parametrize(
    ("own", "mate"),
    [
        pytest.param({"visible": True, "x_m": 30.0, "covariance_m2": NEAR}, {}, id="ball of the own camera outside"),
        pytest.param({}, {"ball_visible": True, "ball_x_m": 90.0, "ball_covariance_m2": NEAR}, id="of a mate outside"),
        pytest.param({"visible": True, "x_m": 2.0, "z_m": 500.0, "covariance_m2": NEAR}, {}, id="ball in the clouds"),
        pytest.param({}, {"ball_held": True, "vx_m_s": 900.0}, id="mate too fast"),
    ],
)
def test_ball_that_cannot_be_is_not_known(own: dict[str, Any], mate: dict[str, Any]) -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(5):
        robot.sense(None, [])
        robot.bench.port("ball_percept").put(**own)
        told = team_message_t(robot="cyan2", localized=True, x_m=3.0, **mate)
        told.header.time_us = robot.bench.time_us
        robot.bench.port("team_inbox").put(messages=[told])
        robot.bench.iterate()
        assert not robot.world.ball.known
    assert not any(
        message.ball_visible and message.ball_x_m > 20.0 for message in robot.bench.port("team_message").sent
    )


@pytest.mark.parametrize("by_mate", [False, True])
def test_kick_that_no_robot_can_give_is_ignored(by_mate: bool) -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for tick in range(30):
        robot.sense(np.array((2.0, 0.0)) if tick < 25 else None, [])
        kicks, told = int(tick >= 25), team_message_t(robot="cyan2", localized=True, x_m=-3.0)
        told.header.time_us = robot.bench.time_us
        if by_mate:
            told.kicks, told.kick_us, told.kick_vx_m_s = kicks, robot.bench.time_us, 900.0
        else:
            robot.bench.port("kicker_state").put(kicks=kicks, kick_speed_m_s=900.0)
        robot.bench.port("team_inbox").put(messages=[told])
        robot.bench.iterate()
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((2.0, 0.0), abs=0.1)
    assert robot.bench.port("team_message").sent[-1].kicks == 0


def test_many_candidates_cost_no_more_than_the_first() -> None:
    """The ball is the last of 500 things in a frame that seem less likely: those after the first 20 do not count."""
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for _ in range(10):
        robot.sense(np.array((2.0, 0.0)), [])
        robot.bench.iterate()
    others = [ball_candidate_t(x_m=-0.01 * number, y_m=5.0, covariance_m2=NEAR) for number in range(499)]
    others.append(ball_candidate_t(x_m=2.0, covariance_m2=NEAR))
    robot.sense(None, [])
    robot.bench.port("ball_percept").put(visible=True, x_m=-3.0, covariance_m2=NEAR, others=others)
    robot.bench.iterate()
    assert robot.world.ball.age_s > 0.0
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((2.0, 0.0), abs=0.1)

"""World models of a team on the bench, connected by radio: frames, sources, messages to mates, opponents."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, pass_agreement_t, team_message_t
from procs.model.frames import rotation
from procs.simulation.radio import Radio
from procs.world_model.seen import Seen
from procs.world_model.world_model import WorldModel

Floats = NDArray[np.float64]
PERIOD_S = 0.05
POSE_DEVIATIONS = np.array((0.015, 0.015, 0.004))
POSE_MEMORY = 0.8  # the pose's error persists from frame to frame, as that of a localization does


class Robot:
    """A robot with a true pose, a slightly wrong estimated pose, and a camera; its world model is on the bench."""

    def __init__(self, name: str, pose: tuple[float, float, float], seed: int, **settings: Any) -> None:
        self.name = name
        self.pose = np.array(pose)
        self.rng = np.random.default_rng(seed)
        self.pose_error = POSE_DEVIATIONS * self.rng.standard_normal(3)
        self.bench = Bench(WorldModel, f"{name}/world_model", **settings)
        self.role = "supporter"
        self.localized = True

    def deviations_m(self, distance_m: float) -> Floats:
        """Returns standard deviations along and across the ray."""
        return np.array((0.01 + 0.005 * distance_m**2, 0.01 + 0.003 * distance_m))

    def in_frame(self, point_m: Floats) -> tuple[Floats, Floats]:
        """Returns a noisy sighting in the robot frame, and its covariance."""
        seen_m = rotation(-self.pose[2]) @ (point_m - self.pose[:2])
        deviations_m = self.deviations_m(float(np.hypot(*seen_m)))
        turn = rotation(math.atan2(seen_m[1], seen_m[0]))
        return seen_m + turn @ (deviations_m * self.rng.standard_normal(2)), turn @ np.diag(deviations_m**2) @ turn.T

    def sense(self, ball_m: Floats | None, others_m: list[Floats], held: bool = False) -> None:
        """Puts a frame on the bench: sightings of ball and robots, the pose, and the other inputs."""
        fresh = POSE_DEVIATIONS * self.rng.standard_normal(3)
        self.pose_error = POSE_MEMORY * self.pose_error + math.sqrt(1 - POSE_MEMORY**2) * fresh
        x_m, y_m, heading_rad = (self.pose + self.pose_error).tolist()
        covariance = np.diag(POSE_DEVIATIONS**2).tolist()
        port = self.bench.port
        port("pose").put(x_m=x_m, y_m=y_m, heading_rad=heading_rad, covariance=covariance, localized=self.localized)
        port("odometry").put()
        port("kicker_state").put(ball_held=held)
        said = pass_agreement_t()
        said.receiver, said.x_m, said.y_m = f"for {self.name}", 1.5, -2.0
        port("role").put(role=self.role, intention="testing", agreement=said)
        if ball_m is None:
            port("ball_percept").put(visible=False)
        else:
            (bx_m, by_m), spread = self.in_frame(ball_m)
            port("ball_percept").put(
                visible=True, x_m=float(bx_m), y_m=float(by_m), covariance_m2=spread.tolist(), confidence=0.9
            )
        obstacles = []
        for other_m in others_m:
            obstacle = obstacle_t()
            (ox_m, oy_m), spread = self.in_frame(other_m)
            obstacle.x_m, obstacle.y_m, obstacle.radius_m = float(ox_m), float(oy_m), 0.25
            obstacle.covariance_m2 = spread.tolist()
            obstacles.append(obstacle)
        port("obstacle_percepts").put(obstacles=obstacles)

    @property
    def world(self) -> Any:
        return self.bench.port("world_model").sent[-1]


class TeamOnBench:
    """Robots connected by radio."""

    def __init__(self, robots: list[Robot], **radio: float) -> None:
        self.robots = robots
        names = tuple(robot.name for robot in robots)
        settings: dict[str, Any] = {"loss": 0.0, "delay_jitter_s": 0.0, **radio}
        self.radio = Bench(Radio, "team_cyan/radio", namespaces=names, **settings)

    def tick(self, ball_m: Floats | None, blind: tuple[str, ...] = (), others_m: tuple[Floats, ...] = ()) -> None:
        """Runs a tick of all robots, which see each other and `others_m`; the `blind` ones do not see the ball."""
        for robot in self.robots:
            around = [other.pose[:2] for other in self.robots if other is not robot] + list(others_m)
            robot.sense(None if robot.name in blind else ball_m, around)
            robot.bench.iterate()
            for message in robot.bench.port("team_message").sent:
                self.radio.port("messages", robot.name).put(message)
            robot.bench.port("team_message").sent.clear()
        self.radio.iterate()
        for robot in self.robots:
            inbox = self.radio.port("inboxes", robot.name).sent
            for message in inbox:
                robot.bench.port("team_inbox").put(message)
            inbox.clear()


def team(seed: int = 0, **radio: float) -> TeamOnBench:
    poses = [(-2.0, 0.5, 0.3), (3.0, -2.0, 2.5), (-4.0, 4.0, -1.0), (5.0, 4.0, -2.5)]
    robots = [Robot(f"cyan{n + 1}", pose, 100 * seed + n, mate_timeout_s=2.0) for n, pose in enumerate(poses)]
    return TeamOnBench(robots, **radio)


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


def decoded(robot: Robot, data: bytes) -> list[team_message_t]:
    port = robot.bench.port("team_inbox")
    return list(port.message_type.decode(data).messages)


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
        assert world.mate_roles == [mate.role for mate in mates]
        told_passes = [(said.receiver, said.x_m, said.y_m) for said in world.mate_agreements]
        assert told_passes == [(f"for {mate.name}", 1.5, -2.0) for mate in mates]
        for told, mate in zip(world.mates, mates, strict=True):
            assert (told.x_m, told.y_m) == pytest.approx(mate.pose[:2].tolist(), abs=0.08)
        places = np.array([(one.x_m, one.y_m) for one in world.opponents])
        assert len(places) == 2, "one of them touches a mate"
        for opponent in opponents:
            assert np.hypot(*(places - opponent).T).min() < 0.25


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


def test_held_ball_is_in_the_mouth_and_in_the_message() -> None:
    robot = Robot("cyan1", (1.0, -1.0, -math.pi / 2), seed=1)
    for _ in range(4):
        robot.sense(None, [], held=True)
        robot.bench.iterate()
    assert (robot.world.ball.x_m, robot.world.ball.y_m) == pytest.approx((1.0, -1.33), abs=0.05)
    assert robot.bench.port("team_message").sent[-1].ball_held


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


def test_kick_is_sent_at_once_and_only_once() -> None:
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
    assert (told[-1].kicks, told[-1].kick_us) == (1, robot.bench.time_us)
    robot.sense(np.array((0.7, 0.0)), [])
    robot.bench.port("kicker_state").put(ball_held=False, kicks=1, kick_speed_m_s=8.0)
    robot.bench.iterate()
    assert len(told) == before + 1

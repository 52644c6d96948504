"""World models of a team of robots on the bench, connected by radio."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, pass_agreement_t, team_message_t
from procs.model.frames import rotation
from procs.simulation.radio import Radio
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

    def sense(
        self, ball_m: Floats | None, others_m: list[Floats], held: bool = False, teams: tuple[int, ...] = ()
    ) -> None:
        """Puts a frame on the bench: sightings of ball and robots, the pose, and the other inputs.

        `teams` are those that the markers of the first robots show.
        """
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
        for number, other_m in enumerate(others_m):
            obstacle = obstacle_t()
            obstacle.team = teams[number] if number < len(teams) else obstacle_t.TEAM_UNKNOWN
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

    def tick(
        self,
        ball_m: Floats | None,
        blind: tuple[str, ...] = (),
        others_m: tuple[Floats, ...] = (),
        teams: tuple[int, ...] = (),
    ) -> None:
        """Runs a tick of all robots, which see each other and `others_m`; the `blind` ones do not see the ball.

        `teams` are those that the markers of the first robots show which a robot sees.
        """
        for robot in self.robots:
            around = [other.pose[:2] for other in self.robots if other is not robot] + list(others_m)
            robot.sense(None if robot.name in blind else ball_m, around, teams=teams)
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


def decoded(robot: Robot, data: bytes) -> list[team_message_t]:
    port = robot.bench.port("team_inbox")
    return list(port.message_type.decode(data).messages)

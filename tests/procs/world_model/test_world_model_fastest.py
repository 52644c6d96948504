"""The hardest kick of the robots: no ball is believed to be faster, and stronger kickers make faster balls believed."""

import math

import numpy as np
import pytest

from lcmtypes.soccer import team_message_t
from procs.model.ball import BALL
from procs.model.robot import ROBOT, RobotModel
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.sighting import Sighting
from tests.procs.world_model.team_on_bench import Robot

FRAME_S = 0.08
STRONGER = ROBOT.model_copy(update={"kick_limit_m_s": 20.0})


def believed_m_s(seen_m: list[float], fastest_m_s: float) -> list[float]:
    """Returns the believed speed after each frame; `seen_m` is where each shows the ball, with a robot beside it."""
    tracker, speeds_m_s = BallTracker(BALL, fastest_m_s), []
    for x_m in seen_m:
        for _ in range(2):
            tracker.advance(FRAME_S / 2, 2.0, contact=1.0)
        tracker.see(Sighting("a", True, np.array((x_m, 0.0)), np.eye(2) * 0.02**2))
        speeds_m_s.append(math.hypot(*tracker.track.state[2:]))
    return speeds_m_s


@pytest.mark.parametrize(("speed_m_s", "ahead_m"), [(7.0, 0.6), (9.0, 0.6), (11.0, 0.3), (11.0, 0.6)])
def test_phantom_ahead_of_a_fast_ball_is_no_kick(speed_m_s: float, ahead_m: float) -> None:
    """One frame shows another thing on the ball's way, near enough for a kick that no kicker can make."""
    seen_m = [speed_m_s * FRAME_S * frame for frame in range(14)]
    seen_m[9] += ahead_m
    speeds_m_s = believed_m_s(seen_m, ROBOT.fastest_ball_m_s)
    assert max(speeds_m_s) <= ROBOT.fastest_ball_m_s
    assert speeds_m_s[-1] == pytest.approx(speed_m_s, rel=0.05)


@pytest.mark.parametrize(("robot", "speed_m_s"), [(ROBOT, 12.0), (STRONGER, 18.0)])
def test_hardest_kick_is_known_with_the_second_frame(robot: RobotModel, speed_m_s: float) -> None:
    seen_m = [max(0.0, speed_m_s * FRAME_S * (frame - 9.5)) for frame in range(12)]
    assert believed_m_s(seen_m, robot.fastest_ball_m_s)[-1] == pytest.approx(speed_m_s, rel=0.1)


@pytest.mark.parametrize("by_mate", [False, True])
@pytest.mark.parametrize(("geometry", "counts"), [(ROBOT, False), (STRONGER, True)])
def test_kick_counts_if_a_kicker_is_strong_enough(geometry: RobotModel, counts: bool, by_mate: bool) -> None:
    robot = Robot("cyan1", (0.0, 0.0, 0.0), seed=1, robot=geometry)
    for tick in range(26):
        kicks, told = int(tick == 25), team_message_t(robot="cyan2", localized=True, x_m=1.67)
        robot.sense(None if kicks else np.array((2.0, 0.0)), [])
        told.header.time_us = robot.bench.time_us
        if by_mate:
            told.kicks, told.kick_us, told.kick_vx_m_s = kicks, robot.bench.time_us, 18.0
        else:
            robot.bench.port("kicker_state").put(kicks=kicks, kick_speed_m_s=18.0)
        robot.bench.port("team_inbox").put(messages=[told])
        robot.bench.iterate()
    assert (robot.world.ball.vx_m_s > 10.0) is counts

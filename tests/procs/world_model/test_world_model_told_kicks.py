"""Kicks in messages: which of them count, on the bench and in a match of the launch file."""

import math
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench, system_of
from lcmtypes.soccer import team_message_t
from procs.world_model.world_messages import fill_plan
from procs.world_model.world_model import WorldModel

PERIOD_S = 0.04
CERTAIN = (np.eye(3) * 1e-4).tolist()


class Watcher:
    """A world model on the bench that sees a ball at (3, 1)."""

    def __init__(self, name: str) -> None:
        self.bench = Bench(WorldModel, f"{name}/world_model", period_s=PERIOD_S)

    def tick(
        self,
        times: int = 1,
        localized: bool = True,
        told: team_message_t | None = None,
        visible: bool = True,
        **kicker: Any,
    ) -> None:
        for _ in range(times):
            port = self.bench.port
            port("pose").put(covariance=CERTAIN, localized=localized)
            port("odometry").put()
            port("kicker_state").put(**kicker)
            port("ball_percept").put(visible=visible, x_m=3.0, y_m=1.0, covariance_m2=(np.eye(2) * 1e-4).tolist())
            if told is not None:
                told.header.time_us = self.bench.time_us
                port("team_inbox").put(messages=[told])
            self.bench.iterate()

    @property
    def ball_speed_m_s(self) -> float:
        ball = self.bench.port("world_model").sent[-1].ball
        return math.hypot(ball.vx_m_s, ball.vy_m_s)

    @property
    def told(self) -> team_message_t:
        message: team_message_t = self.bench.port("team_message").sent[-1]
        return message


def kick_of(mate: str, kicks: int, kick_us: int, localized: bool = True) -> team_message_t:
    """Returns a mate's message of a kick at 10 m/s."""
    message = team_message_t(robot=mate, localized=localized, x_m=2.7, y_m=1.0, pose_covariance=CERTAIN)
    message.kicks, message.kick_us, message.kick_vx_m_s = kicks, kick_us, 10.0
    return message


def speed_after_mates_kicks(*kicks: int, localized: bool = True, lies: bool = False) -> float:
    """Returns the believed speed of a ball after messages with these numbers of kicks, the last of a fresh kick.

    If it `lies`, the robot sees it in its place twice after that kick.
    """
    watcher = Watcher("cyan2")
    for number in kicks[:-1]:
        watcher.tick(10, told=kick_of("cyan1", number, 1))
    watcher.tick(1 + lies, told=kick_of("cyan1", kicks[-1], watcher.bench.time_us, localized), visible=lies)
    return watcher.ball_speed_m_s


def test_kick_that_a_mate_tells_counts() -> None:
    assert speed_after_mates_kicks(3, 4) > 5.0


def test_told_kick_of_a_ball_that_is_seen_to_lie_has_missed() -> None:
    assert speed_after_mates_kicks(3, 4, lies=True) < 0.5


@pytest.mark.parametrize("kicks", [(3, 3), (3, 1)])
def test_old_number_of_kicks_or_a_lower_one_is_no_kick(kicks: tuple[int, int]) -> None:
    assert speed_after_mates_kicks(*kicks) < 0.1


def test_kick_of_a_mate_that_is_lost_does_not_count() -> None:
    assert speed_after_mates_kicks(3, 4, localized=False) < 0.1


def test_lost_robot_tells_no_kick() -> None:
    lost = Watcher("cyan1")
    lost.tick(5, localized=False)
    lost.tick(3, localized=False, kicks=1, kick_speed_m_s=8.0)
    assert (lost.told.kicks, lost.told.kick_vx_m_s) == (0, 0.0)


def test_restarted_driver_or_world_model_invents_no_kick() -> None:
    watcher = Watcher("cyan1")
    watcher.tick(10, kicks=5, kick_speed_m_s=8.0)
    assert watcher.ball_speed_m_s < 0.1
    watcher.tick(3, kicks=0)
    assert (watcher.told.kicks, watcher.ball_speed_m_s < 0.1) == (0, True)
    watcher.tick(3, kicks=1, kick_speed_m_s=8.0)
    assert (watcher.told.kicks, watcher.told.kick_vx_m_s) == (1, 8.0)


def test_mates_learn_the_first_kick_of_a_restarted_driver() -> None:
    kicker, mate = Watcher("cyan1"), Watcher("cyan2")
    heard = 0
    for kicks, ticks in ((5, 10), (6, 10), (0, 10), (1, 3)):
        for _ in range(ticks):
            kicker.tick(kicks=kicks, kick_speed_m_s=8.0, visible=kicks != 1)
            sent = kicker.bench.port("team_message").sent[heard:]
            heard += len(sent)
            mate.tick(told=sent[-1] if sent else None, visible=kicks != 1)
    assert mate.ball_speed_m_s > 5.0


ROBOTS = ("cyan1", "cyan3", "cyan4", "cyan5")


@pytest.mark.slow
@pytest.mark.parametrize("lost", [False, True])
def test_match_survives_damaged_messages_of_a_robot(lost: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a match of the launch file a mate states what is no covariance, or tells kicks although it is lost.

    No robot touches the ball in this match before the test ends.
    """
    system = system_of("soccer-percepts.yaml", seed=3)

    def damage(message: team_message_t, *parts: Any) -> None:
        fill_plan(message, *parts)
        if message.robot != "cyan2":
            return
        message.ball_visible, message.ball_covariance_m2 = True, [[1e-3, -1.0], [0.0, 1e-3]]
        if lost:
            message.localized, message.ball_visible = False, False
            message.kicks, message.kick_us, message.kick_vx_m_s = system.ticks // 30, system.now_us, 10.0

    monkeypatch.setattr("procs.world_model.world_model.fill_plan", damage)
    for tick in range(100):
        system.tick()
        truth = system.newest("world/ground_truth")
        for robot in ROBOTS if tick >= 50 else ():
            ball = system.newest(f"{robot}/world_model").ball
            away_m = math.dist((ball.x_m, ball.y_m), (truth.ball_x_m, truth.ball_y_m))
            wrong_m_s = math.dist((ball.vx_m_s, ball.vy_m_s), (truth.ball_vx_m_s, truth.ball_vy_m_s))
            assert away_m < 0.5, f"{robot}, tick {tick}"
            assert wrong_m_s < 2.0, f"{robot}, tick {tick}"

"""The ball as a robot knows it: what a tick brings is taken, and what the team has to be told is kept."""

import numpy as np
import pytest

from lcmtypes.robot import kicker_state_t, odometry_t
from lcmtypes.soccer import ball_percept_t, game_state_t, pose_t, team_message_t
from procs.model.frames import Floats
from procs.model.game_states import State
from procs.world_model.ball_follower import BallFollower, BallNews
from procs.world_model.own_view import OwnView, Shaking
from procs.world_model.robot_tracks import RobotTracks
from procs.world_model.settings import WorldModelConfig
from procs.world_model.told import mate_of

TICK_US = 40_000
KICK_M_S = 6.0
STILL = Shaking(0.0, 0.0)
CERTAIN = np.eye(3) * 1e-4


def view() -> OwnView:
    pose = pose_t(x_m=1.0, y_m=0.0, heading_rad=0.0, localized=True, covariance=CERTAIN.tolist())
    return OwnView(pose, odometry_t(), True, STILL, None, 0.04)


def news(
    tick: int,
    *,
    kicker: kicker_state_t | None = None,
    game: game_state_t | None = None,
    percept: ball_percept_t | None = None,
    told: team_message_t | None = None,
    tick_us: int = TICK_US,
) -> BallNews:
    holds = kicker is not None and bool(kicker.ball_held)
    mate = mate_of(told, tick * tick_us / 1e6) if told else None
    heard = [(told, mate)] if told and mate else []
    return BallNews(tick * tick_us, tick_us / 1e6, tick_us / 1e6, holds, kicker, game, percept, heard)


def place_m(follower: BallFollower) -> Floats:
    return follower.tracker.track.state[:2]


@pytest.fixture
def follower() -> BallFollower:
    return BallFollower("cyan1", WorldModelConfig())


def test_seen_ball_is_kept_for_the_team(follower: BallFollower) -> None:
    percept = ball_percept_t(visible=True, x_m=2.0, y_m=0.5, covariance_m2=(np.eye(2) * 1e-4).tolist())
    follower.follow(news(1, percept=percept), view(), [])
    assert place_m(follower) == pytest.approx((3.0, 0.5), abs=0.05)
    assert follower.untold.positions_m[0] == pytest.approx((3.0, 0.5), abs=0.05)


def test_kick_is_returned_once(follower: BallFollower) -> None:
    held = kicker_state_t(ball_held=True)
    kicked = kicker_state_t(kicks=1, kick_speed_m_s=6.0)
    assert follower.follow(news(1, kicker=held), view(), []) is None
    kick = follower.follow(news(2, kicker=kicked), view(), [])
    assert kick is not None
    assert kick.velocity_m_s == pytest.approx((6.0, 0.0), abs=0.01)
    assert follower.follow(news(3, kicker=kicked), view(), []) is None
    assert follower.tracker.track.state[2] > 4.0


@pytest.mark.parametrize("by_mate", [False, True])
@pytest.mark.parametrize("tick_us", [10_000, 40_000, 100_000])
def test_place_of_a_kicked_ball_is_as_open_as_the_tick(follower: BallFollower, tick_us: int, by_mate: bool) -> None:
    """The kick lies somewhere in a tick: its deviation is the tick by the root of 12."""
    mate = team_message_t(robot="cyan2", localized=True, x_m=1.0, pose_covariance=CERTAIN.tolist())
    kicker = kicker_state_t(ball_held=not by_mate)
    follower.follow(news(1, kicker=kicker, told=mate, tick_us=tick_us), view(), [])
    mate.kicks, mate.kick_us, mate.kick_vx_m_s = int(by_mate), 2 * tick_us - tick_us // 2, KICK_M_S
    kicker = kicker_state_t(kicks=int(not by_mate), kick_speed_m_s=KICK_M_S)
    follower.follow(news(2, kicker=kicker, told=mate, tick_us=tick_us), view(), [])
    along_m, across_m = np.sqrt(np.diag(follower.tracker.track.covariance)[:2])
    assert along_m**2 - across_m**2 == pytest.approx((KICK_M_S * tick_us / 1e6) ** 2 / 12, rel=0.4)


def test_ball_that_the_crew_puts_down_is_known(follower: BallFollower) -> None:
    game = game_state_t(state=State.FREE_KICK, stopped=True, ball_x_m=-4.0, ball_y_m=2.0)
    follower.follow(news(1, game=game), view(), [])
    assert place_m(follower) == pytest.approx((-4.0, 2.0), abs=0.05)


def test_tracks_of_robots_are_moved_to_the_end_of_the_tick() -> None:
    tracks = RobotTracks()
    assert tracks.rows_after(0.04) == []
    for step in range(20):
        if step:
            tracks.predict(0.04, 1.0)
        tracks.see(np.array([[0.08 * step, 1.0]]), np.eye(2)[None] * 1e-4)
    ((x_m, y_m, vx_m_s, vy_m_s, place_m2),) = tracks.rows_after(0.04)
    assert (x_m, y_m) == pytest.approx((0.08 * 20, 1.0), abs=0.05)
    assert (vx_m_s, vy_m_s) == pytest.approx((2.0, 0.0), abs=0.3)
    assert 0.0 < place_m2 < 1e-3

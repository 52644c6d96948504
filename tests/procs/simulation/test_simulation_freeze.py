"""A frozen world: nothing moves, no kick is carried out later, the time of the match stands still."""

import math

import pytest

from fwk.testing import Bench, MemorySystem, system_of
from lcmtypes.core import answer_t
from lcmtypes.robot import kick_command_t, kicker_drive_t, kicker_sensor_t
from lcmtypes.soccer import (
    freeze_world_t,
    game_state_t,
    ground_truth_t,
    match_event_t,
    match_events_t,
    place_ball_t,
    place_robot_t,
    referee_command_t,
)
from procs.referee.referee import Referee
from procs.simulation.simulator import Simulator


def by_hand(**settings: str) -> MemorySystem:
    """Returns a match of cyan1 alone, without its agent; `settings` are those of the referee."""
    return system_of(
        "soccer-truth.yaml",
        lambda name: name.startswith(("world/", "cyan1/")) and name != "cyan1/agent",
        sets=[f"world/referee.{name}={value}" for name, value in settings.items()],
    )


def freeze(system: MemorySystem, frozen: bool = True) -> None:
    system.come_in("world/freeze@outside", freeze_world_t(frozen=frozen))
    system.tick()


def truth(system: MemorySystem) -> ground_truth_t:
    newest: ground_truth_t = system.newest("world/ground_truth")
    return newest


def game(system: MemorySystem) -> game_state_t:
    newest: game_state_t = system.newest("world/game_state")
    return newest


def with_ball_in_mouth() -> MemorySystem:
    """Returns cyan1 without an agent; the ball rolls into its mouth while the world is frozen."""
    system = by_hand()
    system.tick(2)
    system.come_in("world/place_robot@outside", place_robot_t(robot="cyan1", x_m=-3.0, y_m=1.0))
    system.come_in("world/place_ball@outside", place_ball_t(x_m=-2.6, y_m=1.0, vx_m_s=-0.5))
    for _ in range(20):
        system.tick()
        sensor: kicker_sensor_t = system.newest("cyan1/kicker_sensor")
        if sensor.ball_held:
            freeze(system)
            return system
    raise AssertionError("the ball does not roll into the mouth")


def test_kick_asked_for_in_a_frozen_world_stays_failed() -> None:
    system = with_ball_in_mouth()
    system.come_in("cyan1/kick@outside", kick_command_t(speed_m_s=5.0))
    system.tick(250)
    answers = [answer_t.FAILED, "the hardware has not kicked"]
    answer = system.newest("cyan1/kick@answers").answer
    assert [answer.state, answer.reason] == answers
    freeze(system, frozen=False)
    system.tick(5)
    now = truth(system)
    assert math.hypot(now.ball_vx_m_s, now.ball_vy_m_s) < 1.0
    assert system.newest("cyan1/kicker_sensor").kick_id == 0


def test_kick_after_a_frozen_world_is_carried_out() -> None:
    system = with_ball_in_mouth()
    system.tick(50)
    freeze(system, frozen=False)
    system.come_in("cyan1/kick@outside", kick_command_t(speed_m_s=5.0))
    system.tick(4)
    assert truth(system).ball_vx_m_s > 3.0


def test_kick_on_its_way_is_dropped_when_the_world_freezes() -> None:
    world = Bench(
        Simulator, name="world/simulator", namespaces=("cyan1",), realism="none", errors={"kick_delay_s": 0.06}
    )
    world.port("place_robot").put(robot="cyan1", x_m=0.0, y_m=1.0)
    world.iterate()
    drive = kicker_drive_t(kick_id=1, kick_m_s=5.0)
    drive.header.time_us = world.time_us
    world.port("kicker_drive", "cyan1").put(drive)
    world.iterate()
    world.port("freeze").put(frozen=True)
    world.iterate(20)
    world.port("freeze").put(frozen=False)
    world.iterate(5)
    assert world.port("kicker_sensor", "cyan1").sent[-1].kick_id == 0


@pytest.mark.slow
def test_time_of_the_match_stands_still_in_a_frozen_world() -> None:
    """12 s are longer than a deadlock, a set piece, and any stay that the rules allow."""
    system = system_of("soccer-truth.yaml", seed=3)
    while game(system).state != game_state_t.PLAY:
        system.tick()
    freeze(system)
    before, place = game(system), truth(system).ball_x_m
    system.tick(300)
    now = game(system)
    assert (now.time_in_half_s, now.time_in_state_s) == (before.time_in_half_s, before.time_in_state_s)
    assert (now.state, now.stopped, now.decisions) == (before.state, before.stopped, before.decisions)
    assert truth(system).ball_x_m == place
    freeze(system, frozen=False)
    assert game(system).time_in_half_s == pytest.approx(before.time_in_half_s + 0.04)


def test_half_does_not_end_in_a_frozen_world() -> None:
    system = by_hand(half_s="2")
    system.tick(25)
    freeze(system)
    system.tick(100)
    assert game(system).state == game_state_t.KICK_OFF
    assert game(system).time_in_half_s == pytest.approx(1.0)
    freeze(system, frozen=False)
    system.tick(30)
    assert game(system).state == game_state_t.HALF_TIME


def test_referee_obeys_commands_in_a_frozen_world() -> None:
    system = by_hand()
    system.tick(5)
    freeze(system)
    system.come_in("world/referee_command@outside", referee_command_t(name="goal", team="cyan"))
    system.tick(2)
    assert game(system).score_cyan == 1


def test_goal_before_a_freeze_counts_in_a_late_tick() -> None:
    referee = Bench(Referee, "world/referee", kick_off_stoppage_s=0.5)
    for _ in range(12):
        referee.port("match_events").put()
        referee.iterate()
    kick = match_event_t(kind=match_event_t.TOUCH, robot="cyan2", x_m=6.0, speed_m_s=5.0)
    goal = match_event_t(kind=match_event_t.GOAL, robot="cyan2", x_m=11.2, speed_m_s=5.0)
    referee.port("match_events").put(match_events_t(ball_x_m=3.0))
    referee.iterate()
    referee.port("match_events").put(match_events_t(ball_x_m=11.2, events=[kick, goal]))
    referee.port("match_events").put(match_events_t(ball_x_m=11.2, frozen=True))
    referee.iterate()
    assert referee.port("game_state").sent[-1].score_cyan == 1

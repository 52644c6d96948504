"""The kicker's driver: when it fires, when it waits, when it forgets."""

from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.robot import kick_command_t
from procs.drivers.kicker import Kicker

READY = {"ball_held": True, "charged": True}


@pytest.fixture
def kicker() -> Bench:
    return Bench(Kicker)


def act(kicker: Bench, command: dict[str, Any] | None = None, sensor: dict[str, Any] | None = None) -> Any:
    """One tick; returns what the hardware is told."""
    if sensor is not None:
        kicker.port("kicker_sensor").put(**sensor)
    if command is not None:
        message = kick_command_t()
        message.header.time_us = kicker.time_us + 50_000
        kicker.port("kick_command").put(message, **command)
    kicker.iterate()
    return kicker.port("kicker_drive").sent[-1]


def test_kicker_fires_with_ball_and_charge(kicker: Bench) -> None:
    drive = act(kicker, {"kick_id": 1, "speed_m_s": 8.0}, READY)
    assert (drive.kick_id, drive.kick_m_s) == (1, 8.0)


@pytest.mark.parametrize("sensor", [{"ball_held": False, "charged": True}, {"ball_held": True, "charged": False}])
def test_kicker_waits_for_ball_and_charge(kicker: Bench, sensor: dict[str, bool]) -> None:
    assert act(kicker, {"kick_id": 1, "speed_m_s": 8.0}, sensor).kick_m_s == 0.0
    assert act(kicker, sensor=READY).kick_m_s == 8.0


def test_kick_is_carried_out_once(kicker: Bench) -> None:
    act(kicker, {"kick_id": 1, "speed_m_s": 8.0}, READY)
    drive = act(kicker, {"kick_id": 1, "speed_m_s": 8.0}, {**READY, "kick_id": 1})
    assert (drive.kick_id, drive.kick_m_s) == (1, 0.0)
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kick_id, state.kicks) == (1, 1)


def test_speed_zero_takes_a_waiting_kick_back(kicker: Bench) -> None:
    act(kicker, {"kick_id": 1, "speed_m_s": 8.0}, {"charged": True})
    assert act(kicker, {"kick_id": 1, "speed_m_s": 0.0}, READY).kick_m_s == 0.0


@pytest.mark.parametrize("speed_m_s", [0.0, -3.0, float("nan")])
def test_implausible_speed_does_not_kick(kicker: Bench, speed_m_s: float) -> None:
    drive = act(kicker, {"kick_id": 1, "speed_m_s": speed_m_s}, READY)
    assert (drive.kick_id, drive.kick_m_s) == (0, 0.0)


def test_old_command_is_forgotten(kicker: Bench) -> None:
    act(kicker, {"kick_id": 1, "speed_m_s": 8.0, "dribble": True}, {"charged": True})
    for _ in range(6):
        drive = act(kicker)
    assert not drive.dribble
    assert act(kicker, sensor=READY).kick_m_s == 0.0
    assert [line.text for line in kicker.logged] == ["no kick command for 0.30 s: ball handling stops"]


def test_speed_is_limited(kicker: Bench) -> None:
    assert act(kicker, {"kick_id": 1, "speed_m_s": 99.0}, READY).kick_m_s == 12.0


def test_ball_handling_follows_the_command(kicker: Bench) -> None:
    assert act(kicker, {"dribble": True}, READY).dribble
    assert not act(kicker, {"dribble": False}).dribble


def test_state_is_what_the_sensor_says(kicker: Bench) -> None:
    act(kicker, sensor={"ball_held": True, "charged": False, "kick_id": 4})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.ball_held, state.charged, state.kick_id) == (True, False, 4)


def test_kicker_ends_with_handling_off_and_without_a_kick(kicker: Bench) -> None:
    act(kicker, {"kick_id": 1, "speed_m_s": 8.0, "dribble": True}, {"charged": True})
    kicker.finalize()
    drive = kicker.port("kicker_drive").sent[-1]
    assert (drive.kick_id, drive.kick_m_s, drive.dribble) == (0, 0.0, False)

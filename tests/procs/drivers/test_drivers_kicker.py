"""The kicker's driver: when it fires, waits, and drops a command."""

import math
import re
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.core import answer_t
from lcmtypes.robot import dribble_command_t
from procs.drivers.kicker import Kicker

READY = {"ball_held": True, "charged": True}
EMPTY = {"ball_held": False, "charged": True}


@pytest.fixture
def kicker() -> Bench:
    return Bench(Kicker)


def act(kicker: Bench, sensor: dict[str, Any] | None = None, dribble: bool | None = None) -> Any:
    """One tick; returns what the hardware is told."""
    if sensor is not None:
        kicker.port("kicker_sensor").put(**sensor)
    if dribble is not None:
        message = dribble_command_t(on=dribble)
        message.header.time_us = kicker.time_us + 50_000
        kicker.port("dribble_command").put(message)
    kicker.iterate()
    return kicker.port("kicker_drive").sent[-1]


def answers(kicker: Bench) -> list[tuple[int, int]]:
    return [(sent.answer.sequence, sent.answer.state) for sent in kicker.kick.sent]


def test_kicker_fires_with_ball_and_charge(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    drive = act(kicker, READY)
    assert (drive.kick_id, drive.kick_m_s) == (1, 8.0)
    assert answers(kicker) == [(1, answer_t.ACCEPTED)]


@pytest.mark.parametrize("sensor", [EMPTY, {"ball_held": True, "charged": False}])
def test_kicker_waits_for_ball_and_charge(kicker: Bench, sensor: dict[str, bool]) -> None:
    kicker.kick.put(speed_m_s=8.0)
    assert act(kicker, sensor).kick_m_s == 0.0
    assert act(kicker, READY).kick_m_s == 8.0


def test_kick_is_carried_out_once(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    act(kicker, READY)
    drive = act(kicker, {**READY, "kick_id": 1})
    assert (drive.kick_id, drive.kick_m_s) == (1, 0.0)
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kick_id, state.kicks, state.kick_speed_m_s) == (1, 1, 8.0)
    assert answers(kicker) == [(1, answer_t.ACCEPTED), (1, answer_t.DONE)]


def test_restarted_driver_does_not_count_earlier_kicks(kicker: Bench) -> None:
    """The hardware has kicked seven times for the driver's predecessor."""
    act(kicker, {**EMPTY, "kick_id": 7})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kick_id, state.kicks) == (7, 0)
    kicker.kick.put(speed_m_s=8.0)
    act(kicker, {**READY, "kick_id": 7})
    act(kicker, {**EMPTY, "kick_id": 8})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kick_id, state.kicks, state.kick_speed_m_s) == (8, 1, 8.0)


def test_restarted_hardware_does_not_count_as_a_kick(kicker: Bench) -> None:
    act(kicker, {**EMPTY, "kick_id": 7})
    act(kicker, {**EMPTY, "kick_id": 0})
    assert kicker.port("kicker_state").sent[-1].kicks == 0


def test_kick_that_waits_too_long_expires(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0, expires_s=0.1)
    for _ in range(2):
        act(kicker, EMPTY)
    assert act(kicker, READY).kick_m_s == 0.0
    assert answers(kicker) == [(1, answer_t.EXPIRED)]


def test_kick_that_the_hardware_ignores_fails(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    for _ in range(8):
        act(kicker, READY)
    assert answers(kicker) == [(1, answer_t.ACCEPTED), (1, answer_t.FAILED)]
    assert kicker.kick.sent[-1].answer.reason == "the hardware has not kicked"


def test_newer_kick_replaces_one_that_the_hardware_ignores(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    act(kicker, READY)
    kicker.kick.put(speed_m_s=3.0)
    drive = act(kicker, READY)
    assert (drive.kick_id, drive.kick_m_s) == (2, 3.0)
    act(kicker, {**READY, "kick_id": 2})
    assert answers(kicker)[1:] == [(1, answer_t.FAILED), (2, answer_t.ACCEPTED), (2, answer_t.DONE)]
    assert kicker.port("kicker_state").sent[-1].kick_speed_m_s == 3.0


def test_replaced_kick_that_comes_late_counts_as_it_was(kicker: Bench) -> None:
    """The hardware needs longer than a tick: it kicks for the first request after it was told of the second."""
    kicker.kick.put(speed_m_s=3.0)
    first = act(kicker, READY)
    kicker.kick.put(speed_m_s=8.0)
    second = act(kicker, READY)
    assert second.kick_id != first.kick_id
    act(kicker, {**EMPTY, "kick_id": first.kick_id})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kicks, state.kick_speed_m_s) == (1, 3.0)
    assert (2, answer_t.DONE) not in answers(kicker)
    act(kicker, {**EMPTY, "kick_id": second.kick_id})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.kicks, state.kick_speed_m_s) == (2, 8.0)
    assert answers(kicker)[-1] == (2, answer_t.DONE)


@pytest.mark.parametrize("sensor", [READY, EMPTY, {"ball_held": True, "charged": False}])
@pytest.mark.parametrize(
    ("speed_m_s", "elevation_rad"),
    [(0.0, 0.0), (-3.0, 0.0), (math.nan, 0.0), (math.inf, 0.0), (1e9, 0.0), (8.0, math.nan), (8.0, math.inf)],
)
def test_implausible_kick_is_refused_at_once(
    kicker: Bench, speed_m_s: float, elevation_rad: float, sensor: dict[str, bool]
) -> None:
    kicker.kick.put(speed_m_s=speed_m_s, elevation_rad=elevation_rad)
    drive = act(kicker, sensor)
    assert (drive.kick_id, drive.kick_m_s) == (0, 0.0)
    assert answers(kicker) == [(1, answer_t.REJECTED)]


def test_refusal_does_not_wait_behind_a_waiting_kick(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    kicker.kick.put(speed_m_s=-1.0)
    act(kicker, EMPTY)
    assert answers(kicker) == [(2, answer_t.REJECTED)]
    assert act(kicker, READY).kick_m_s == 8.0


def test_old_dribble_command_is_forgotten(kicker: Bench) -> None:
    act(kicker, {"charged": True}, dribble=True)
    for _ in range(6):
        drive = act(kicker)
    assert not drive.dribble
    assert [line.text for line in kicker.logged] == ["no dribble command for 0.30 s: ball handling stops"]


def test_speed_is_limited(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=99.0)
    assert act(kicker, READY).kick_m_s == 12.0


def test_steep_kick_is_told_as_slow_as_it_is() -> None:
    """All kicks share one limit, of the robot's model; a lob spends part of it on height."""
    kicker = Bench(Kicker, robot={"kick_limit_m_s": 6.0})
    kicker.kick.put(speed_m_s=8.0, elevation_rad=1.0)
    drive = act(kicker, READY)
    act(kicker, {**EMPTY, "kick_id": 1})
    state = kicker.port("kicker_state").sent[-1]
    assert drive.kick_m_s == state.kick_speed_m_s == pytest.approx(6.0 * math.cos(1.0))
    assert state.kick_elevation_rad == 1.0


def test_ball_handling_follows_the_command(kicker: Bench) -> None:
    assert act(kicker, READY, dribble=True).dribble
    assert not act(kicker, dribble=False).dribble


def test_state_is_what_the_sensor_says(kicker: Bench) -> None:
    act(kicker, {"ball_held": True, "charged": False, "kick_id": 4})
    state = kicker.port("kicker_state").sent[-1]
    assert (state.ball_held, state.charged, state.kick_id) == (True, False, 4)


@pytest.mark.parametrize("period_s", [0.05, 0.02, 0.1])
def test_silent_kicker_holds_no_ball_after_half_a_second(period_s: float) -> None:
    kicker = Bench(Kicker, period_s=period_s)
    for _ in range(3):
        act(kicker, {**READY, "charge": 1.0})
    heard_us = kicker.time_us
    for _ in range(100):
        act(kicker)
        state = kicker.port("kicker_state").sent[-1]
        known = kicker.time_us - heard_us <= 500_000
        assert (state.ball_held, state.charged, state.charge) == (known, known, float(known))
    warnings = [line.text for line in kicker.logged]
    assert len(warnings) == 1
    assert re.fullmatch(r"no reading of the kicker for 0\.[56]\d s: no ball is held, and no kick possible", warnings[0])
    act(kicker, READY)
    assert kicker.port("kicker_state").sent[-1].ball_held


def test_kick_waits_while_the_hardware_is_silent(kicker: Bench) -> None:
    act(kicker, READY)
    kicker.iterate(20)
    kicker.kick.put(speed_m_s=8.0)
    assert act(kicker).kick_m_s == 0.0
    assert answers(kicker) == []
    assert act(kicker, READY).kick_m_s == 8.0


def test_kicker_that_begins_before_its_hardware_warns_not(kicker: Bench) -> None:
    kicker.iterate(100)
    assert kicker.logged == []


def test_kicker_ends_with_handling_off_and_without_a_kick(kicker: Bench) -> None:
    kicker.kick.put(speed_m_s=8.0)
    act(kicker, {"charged": True}, dribble=True)
    kicker.finalize()
    drive = kicker.port("kicker_drive").sent[-1]
    assert (drive.kick_id, drive.kick_m_s, drive.dribble) == (0, 0.0, False)
    assert answers(kicker) == [(1, answer_t.FAILED)]

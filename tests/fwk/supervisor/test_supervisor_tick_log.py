"""The tick log without a gateway process: records kept, repeated and waited for."""

from fwk import Component, Writes
from fwk.bus import sync
from fwk.supervisor.tick_log import KEPT
from lcmtypes.core import fetch_records_t
from lcmtypes.robot import imu_t
from tests.fwk.supervisor.memory_run import RUN, MemoryRun, S


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


def begun() -> MemoryRun:
    run = MemoryRun({"r/senses": Senses})
    run.begin()
    return run


def test_loop_is_at_most_a_window_ahead_of_the_gateway() -> None:
    run = begun()
    run.gateway_stands_still = True
    began_us = run.wall_us
    run.play(lambda: run.wall_us > began_us + 5 * S)
    assert run.supervisor.loop.tick == run.supervisor.loop.tick_log.taken + run.supervisor.loop.barrier.window
    assert run.supervisor.loop.waits_for == ["gateway"]
    run.gateway_stands_still = False
    run.play_ticks(30)
    assert run.supervisor.loop.waits_for == []


def test_records_that_the_gateway_lacks_are_sent_again() -> None:
    run = begun()
    run.gateway_stands_still = True
    run.play(lambda: run.supervisor.loop.tick_log.stalled)
    first = run.supervisor.loop.tick_log.taken + 1
    repeated = len(run.record_ticks)
    run.play(lambda: len(run.record_ticks) >= repeated + 16)
    assert set(run.record_ticks[repeated:]) == set(range(first, run.supervisor.loop.tick + 1))


def test_fetched_records_are_sent_again() -> None:
    run = begun()
    run.play_ticks(20)
    fetch = fetch_records_t()
    fetch.run, fetch.first_tick, fetch.last_tick = RUN, 5, 8
    before = len(run.record_ticks)
    run.send_to(run.ports.supervisor, sync.FETCH_RECORDS, fetch.encode(), run.ports.host(run.ports.gateway))
    run.play_ticks(1)
    assert run.record_ticks[before : before + 4] == [5, 6, 7, 8]


def test_old_records_are_dropped_once_the_gateway_has_them() -> None:
    run = begun()
    run.play_ticks(3 * KEPT)
    kept = [tick for tick, _ in run.supervisor.loop.tick_log._kept]
    assert KEPT <= len(kept) <= KEPT + 2

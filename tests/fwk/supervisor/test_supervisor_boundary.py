"""Boundaries in lockstep: the order of decisions and starts does not depend on wall time."""

from collections.abc import Callable
from typing import Any

import pytest

from fwk import Blackboard, Component, MainLoop, PluginControl, Writes
from fwk.engine.boundary import AFTER_ALL_STEPS, TOOLS, BoundaryRequests
from fwk.model.channel_table import facts_of
from fwk.model.requests import main_loop_request, plugin_request
from lcmtypes.core import done_t, tick_events_t
from lcmtypes.robot import imu_t
from tests.fwk.supervisor.memory_run import MemoryRun, S

DIRECTOR, OPENER, LATER = 0, 1, 2
SENSOR_ACQUIRE = 1


class Director(Component):
    stage = "sensor_acquire"
    plugins: PluginControl
    main_loop: MainLoop
    imu: Writes[imu_t]


class Opener(Component):
    stage = "think"
    blackboard: Blackboard
    thought: Writes[imu_t]


class Later(Component):
    stage = "act"
    step: Writes[imu_t]


def run_of(**fields: Any) -> MemoryRun:
    run = MemoryRun({"r/director": Director, "r/opener": Opener, "r/later": Later}, **fields)
    run.begin()
    return run


def asks_once(what: Callable[[done_t], None]) -> Callable[[done_t], None]:
    """Lets the next iteration of the director send a request."""
    asked: list[int] = []

    def alters(done: done_t) -> None:
        if done.host == DIRECTOR and done.kind == done_t.STAGE and (not asked or done.tick == asked[0]):
            asked.append(done.tick)
            what(done)

    return alters


def restarts(name: str) -> Callable[[done_t], None]:
    def asks(done: done_t) -> None:
        done.plugins = [plugin_request(DIRECTOR, "restart", [name])]

    return asks


def takes_over(done: done_t) -> None:
    done.main_loop = [main_loop_request(DIRECTOR, [SENSOR_ACQUIRE])]


def kinds_of(run: MemoryRun, tick: int) -> list[int]:
    return list(run.records[tick - 1].events.kind)


@pytest.mark.parametrize("finalize_us", [0, 10_000, 7 * S])
def test_restart_begins_after_channel_decisions(finalize_us: int) -> None:
    run = run_of()
    run.does_not_stop = {OPENER}
    run.alters = asks_once(restarts("r/opener"))
    run.play(lambda: run.supervisor._core.hosts[OPENER].stopping)
    began_us = run.wall_us
    run.play(lambda: run.wall_us >= began_us + finalize_us)
    run.finalize(OPENER)
    run.play_ticks(2)
    host, start = run.starts[-1]
    assert (host, start.incarnation) == (OPENER, 2)
    assert OPENER not in {fact.component for fact in facts_of(start.blackboard) if fact.kind == "come"}


@pytest.mark.parametrize("init_us", [0, 10_000, 7 * S])
def test_restart_outside_the_schedule_is_waited_for(init_us: int) -> None:
    run = run_of()
    run.alters = asks_once(takes_over)
    run.play(lambda: run.supervisor.loop.schedule.holder == DIRECTOR)
    run.does_not_start = {LATER}
    run.alters = asks_once(restarts("r/later"))
    run.play(lambda: run.starts[-1][0] == LATER and run.starts[-1][1].incarnation == 2)
    tick, began_us = run.supervisor.loop.tick, run.wall_us
    run.play(lambda: run.wall_us >= began_us + init_us)
    assert run.supervisor.loop.tick == tick
    run.ready(LATER)
    run.does_not_start = set()
    run.play_ticks(3)
    assert tick_events_t.HOST_STARTED in kinds_of(run, tick + 1)


@pytest.mark.parametrize("stage", ["finalize", "init"])
def test_lockstep_kills_nothing_by_a_time_out(stage: str) -> None:
    run = run_of()
    run.does_not_stop = {LATER} if stage == "finalize" else set()
    run.does_not_start = {LATER} if stage == "init" else set()
    run.alters = asks_once(restarts("r/later"))
    host = run.supervisor._core.hosts[LATER]
    run.play(lambda: not host.running)
    began_us = run.wall_us
    run.play(lambda: run.wall_us > began_us + 100 * S)
    assert run.killed == []
    assert any("has waited" in text for text in run.texts)
    if stage == "finalize":
        run.finalize(LATER)
    else:
        run.ready(LATER)
    run.play_ticks(2)
    assert host.running


def test_real_time_kills_a_host_that_does_not_stop() -> None:
    run = run_of(clock="wall")
    run.does_not_stop = {LATER}
    run.alters = asks_once(restarts("r/later"))
    run.play(lambda: run.killed == [LATER], 10 * S)
    assert any(text == "r/later: did not stop when asked; killed" for text in run.texts)


def test_start_up_never_gives_up() -> None:
    run = MemoryRun({"r/later": Later})
    run.does_not_start = {0}
    run.play(lambda: any("has waited 58 s for r/later" in text for text in run.texts), 120 * S)
    assert run.killed == []
    run.ready(0)
    run.play_ticks(1)


def test_requests_are_taken_by_tick_step_sender_and_number() -> None:
    requests = BoundaryRequests()
    requests.ask(3, AFTER_ALL_STEPS, TOOLS, "settings", "e")
    requests.ask(3, 2, "b", "plugins", "c")
    requests.ask(3, 2, "b", "main_loop", "d")
    requests.ask(3, 2, "a", "channels", "b")
    requests.ask(2, 7, "z", "plugins", "a")
    assert [request.content for request in requests.take()] == ["a", "b", "c", "d", "e"]
    assert not requests


def test_requests_of_senders_that_left_are_dropped() -> None:
    requests = BoundaryRequests()
    requests.ask(1, 1, "a", "main_loop", 1)
    requests.ask(1, 1, "a", "plugins", 2)
    requests.ask(1, 1, "b", "main_loop", 3)
    requests.drop({"a"}, ("main_loop", "channels"))
    assert [request.content for request in requests.take()] == [2, 3]

"""The main loop without processes: order of datagrams to hosts, and which answers count."""

from collections.abc import Callable

import pytest

from fwk import Component, Reads, Writes
from fwk.bus import sync
from fwk.model.requests import channel_request, lost_message, main_loop_request, plugin_request
from lcmtypes.core import done_t, tick_events_t
from lcmtypes.robot import imu_t
from tests.fwk.supervisor.memory_run import RUN, MemoryRun, S

LEFT, RIGHT = 0, 1
THINK = 5


class Left(Component):
    stage = "think"
    left: Writes[imu_t]
    right: Reads[imu_t]


class Right(Component):
    stage = "think"
    right: Writes[imu_t]
    left: Reads[imu_t]


def pair(clock: str = "simulated") -> MemoryRun:
    run = MemoryRun({"r/left": Left, "r/right": Right}, clock=clock, period_s=0.001)
    run.begin()
    return run


def test_marks_move_with_the_next_stage() -> None:
    run = pair()
    run.play_ticks(1)
    second = next(tick for tick in run.ticks if tick.tick == 2)
    assert dict(zip(second.channel, second.sequence, strict=True)) == {LEFT: 1, RIGHT: 1}


def test_repeated_tick_does_not_carry_newer_marks() -> None:
    run = pair()
    run.does_not_answer = {RIGHT}
    newest = len(run.records)
    run.play(lambda: [tick.tick for tick in run.ticks].count(newest + 1) >= 3)
    told = [tick for tick in run.ticks if tick.tick == newest + 1]
    assert all(list(tick.sequence) == list(told[0].sequence) for tick in told)
    assert [list(tick.absent) for tick in told] == [[], [LEFT], [LEFT]]


def repetition_wait_us(run: MemoryRun, answers: int) -> int:
    """Lets a host answer a repeated tick this often; returns how long the tick was waited for before."""
    run.does_not_answer = {RIGHT}
    tick, repeated = len(run.records) + 1, run.supervisor.loop.barrier.repeated
    run.play(lambda: run.ticks[-1].tick == tick)
    began_us = run.wall_us
    run.play(lambda: run.supervisor.loop.barrier.repeated > repeated)
    waited_us = run.wall_us - began_us
    for _ in range(answers):
        run.done(RIGHT, tick, THINK, sequence=tick)
    run.does_not_answer = set()
    run.play_ticks(1)
    return waited_us


def repetition_waits_us(answers: int) -> list[int]:
    """Returns how long ticks were waited for, each of which a host answers this often once it is repeated."""
    run, waited_us = pair(), []
    run.play_ticks(90)
    for _ in range(11):
        run.play_ticks(10)
        waited_us.append(repetition_wait_us(run, answers))
    return waited_us


def test_ticks_that_are_repeated_in_vain_are_waited_for_longer() -> None:
    first_us, *_, last_us = repetition_waits_us(answers=2)
    assert last_us > first_us + 4_000


def test_lost_ticks_are_repeated_as_soon_as_before() -> None:
    first_us, *_, last_us = repetition_waits_us(answers=1)
    assert last_us < first_us + 200


def test_done_after_the_news_of_death_does_not_count() -> None:
    run = pair()
    run.does_not_answer = {RIGHT}
    before = run.supervisor._core.ledger.latest(RIGHT)
    tick = len(run.records) + 1
    run.play(lambda: run.ticks[-1].tick == tick)
    run.end(RIGHT, -9)
    run.play(lambda: any("ended" in text for text in run.texts))
    run.done(RIGHT, tick, THINK, sequence=99)
    run.play(lambda: len(run.starts) == 3)
    assert run.supervisor._core.ledger.latest(RIGHT) == before
    (void,) = [void for void in run.supervisor._core.ledger.voids if void.channel == RIGHT]
    assert (void.above_sequence, void.before_incarnation) == (before, 2)


def test_dones_of_other_ticks_do_not_count() -> None:
    run = pair()
    run.does_not_answer = {RIGHT}
    tick = len(run.records) + 1
    run.play(lambda: run.ticks[-1].tick == tick)
    run.done(RIGHT, tick + 8, THINK, sequence=99)
    run.done(RIGHT, tick, THINK + 1, sequence=99)
    run.play(lambda: run.supervisor.loop.barrier.repeated > 3)
    assert len(run.records) == tick - 1


def test_host_in_a_debugger_does_not_count_as_late() -> None:
    run = pair("wall")
    run.begin()
    run.supervisor._core.hosts[RIGHT].held = True
    run.does_not_answer.add(RIGHT)
    run.play(lambda: any("r/right is held by its debugger" in text for text in run.texts))
    run.play_ticks(3)
    assert run.supervisor.loop.barrier.late == 0


def test_real_time_names_and_reminds_a_late_host() -> None:
    run = pair("wall")
    run.does_not_answer = {RIGHT}
    run.play(lambda: any("r/right is late" in text for text in run.texts))
    late_tick = run.supervisor._core.hosts[RIGHT].late_with
    assert late_tick
    assert run.supervisor.loop.barrier.late == 1
    run.play(lambda: run.ticks[-1].tick > late_tick[0] + 3)
    reminders = [tick for tick in run.ticks if tick.tick == late_tick[0]][1:]
    assert reminders
    assert all(list(tick.absent) == [LEFT] for tick in reminders)  # nor may a new process take it as its first tick
    assert list(run.ticks[-1].absent) == [RIGHT] or run.ticks[-1].tick == late_tick[0]
    run.does_not_answer = set()
    run.done(RIGHT, *late_tick, sequence=77)
    run.play(lambda: any("r/right is on time again" in text for text in run.texts))
    run.play_ticks(2)
    assert list(run.ticks[-1].absent) == []


def test_paused_run_crosses_boundaries_only() -> None:
    run = pair()
    clock = run.supervisor._core.clock
    clock.pause()
    run.play(lambda: run.supervisor.loop.paused)
    ticks = len(run.records)
    paused_us = run.wall_us
    run.play(lambda: run.wall_us > paused_us + S)
    assert len(run.records) == ticks
    clock.step(1)
    run.play(lambda: len(run.records) == ticks + 1)
    run.play(lambda: run.supervisor.loop.paused)
    assert len(run.records) == ticks + 1


def test_hang_is_named_after_a_second_and_repeatedly() -> None:
    run = pair()
    run.does_not_answer = {RIGHT}
    run.play(lambda: sum("has waited" in text for text in run.texts) >= 3, 10 * S)
    tick = len(run.records) + 1
    assert [text for text in run.texts if "has waited" in text] == [
        f"tick {tick} has waited {seconds} s for r/right" for seconds in (1, 2, 4)
    ]
    assert run.supervisor.loop.waits_for == ["r/right"]
    assert run.statuses[-1].waits_for == ["r/right"]


def test_usual_wait_is_not_reported() -> None:
    run = pair()
    run.play_ticks(50)
    assert run.supervisor.loop.waits_for == []
    assert not any("has waited" in text for text in run.texts)


def test_broken_done_is_refused_counted_and_named() -> None:
    def broken(done: done_t) -> None:
        if done.host == RIGHT:
            done.channel, done.sequence = [1234], [1]

    run = pair()
    run.alters = broken
    run.play(lambda: run.supervisor.loop.barrier.repeated > 12)
    assert [text for text in run.texts if "refused" in text] == [
        "fwk/done: done of r/right with a mark of channel 1234, which it does not write; refused",
        "fwk/done: done of r/right with a mark of channel 1234, which it does not write; refused (10 times)",
    ]
    run.alters = lambda _: None
    run.play_ticks(3)


def test_mark_far_beyond_the_newest_message_is_refused() -> None:
    def far(done: done_t) -> None:
        if done.host == RIGHT:
            done.sequence = [1 << 60]

    run = pair()
    run.alters = far
    run.play(lambda: run.supervisor.loop.barrier.repeated > 2)
    refused = [text for text in run.texts if "refused" in text]
    assert len(refused) == 1
    assert f"done of r/right with mark {1 << 60} of channel 1, whose newest message is 1; refused" in refused[0]
    run.alters = lambda _: None
    run.play_ticks(3)


def asks_for_the_main_loop(done: done_t) -> None:
    done.main_loop = [main_loop_request(LEFT, [THINK])]


def asks_for_an_unknown_stage(done: done_t) -> None:
    done.main_loop = [main_loop_request(RIGHT, [99])]


def asks_to_fly(done: done_t) -> None:
    done.plugins = [plugin_request(RIGHT, "stop", ["r"])]
    done.plugins[0].action = 99


def loses_from_an_unknown_channel(done: done_t) -> None:
    done.lost = [lost_message(99, 1)]


def opens_in_an_unknown_way(done: done_t) -> None:
    done.channels = [channel_request(RIGHT, ["close", 1])]
    done.channels[0].kind = 99


@pytest.mark.parametrize(
    ("mistake", "reason"),
    [
        (asks_for_the_main_loop, "a request of component 0, which it does not have"),
        (asks_for_an_unknown_stage, "a schedule with a stage that the plan does not have"),
        (asks_to_fly, "a plugin request of an unknown kind"),
        (loses_from_an_unknown_channel, "a channel that the plan does not have"),
        (opens_in_an_unknown_way, "a channel request of an unknown kind"),
    ],
)
def test_broken_requests_are_refused(mistake: Callable[[done_t], None], reason: str) -> None:
    def broken(done: done_t) -> None:
        if done.host == RIGHT:
            mistake(done)

    run = pair()
    run.alters = broken
    run.play(lambda: bool(run.texts))
    assert run.texts == [f"fwk/done: done of r/right with {reason}; refused"]
    run.alters = lambda _: None
    run.play_ticks(2)


def test_broken_datagrams_of_hosts_are_refused() -> None:
    run = pair()
    run.report(b"fwk/actual", b"nonsense", run.ports.host(LEFT))
    run.report(sync.DONE, b"nonsense", run.ports.host(LEFT))
    run.play_ticks(2)
    assert sum("refused" in text for text in run.texts) == 2


def test_record_has_all_events_of_a_tick_in_order() -> None:
    run = pair()
    run.play_ticks(2)
    kinds = tick_events_t.STAGE, tick_events_t.STAGE_DONE, tick_events_t.STAGE_DONE
    assert tuple(run.records[-1].events.kind) == kinds
    assert run.records[-1].run == RUN


ACQUIRE = 1
ROBOT, ACTOR = 0, 1
"""Hosts of `robot`."""


class Sensor(Component):
    stage = "sensor_acquire"
    left: Writes[imu_t]


class Thinker(Component):
    stage = "think"
    left: Reads[imu_t]
    right: Writes[imu_t]


class Actor(Component):
    stage = "act"
    right: Reads[imu_t]


def robot() -> MemoryRun:
    """A host with two stages that needs no other host, and a host that reads from it."""
    run = MemoryRun(
        {"r/sensor": Sensor, "r/thinker": Thinker, "r/actor": Actor},
        groups=[["r/sensor", "r/thinker"]],
        clock="simulated",
        period_s=0.001,
    )
    run.begin()
    return run


def test_host_that_runs_ahead_gets_no_further_tick() -> None:
    run = robot()
    run.play_ticks(3)
    assert [(tick.tick, tick.step) for tick in run.ticks if tick.step == THINK] == []
    assert run.supervisor.loop.barrier.repeated == 0
    dones = run.records[-1].events.stage_dones
    done = list(zip(dones.host, dones.step, strict=True))
    assert done == [(ROBOT, ACQUIRE), (ROBOT, THINK), (ACTOR, THINK + 2)]


def test_tick_is_sent_when_an_early_done_is_lost() -> None:
    run = robot()
    run.loses_dones = {(ROBOT, THINK)}
    tick = len(run.records) + 1
    run.play(lambda: (run.ticks[-1].tick, run.ticks[-1].step) == (tick, THINK))
    run.loses_dones.clear()
    run.play_ticks(2)
    assert run.supervisor.loop.barrier.repeated > 0


def test_messages_of_an_early_done_are_visible_in_their_order() -> None:
    run = robot()
    run.does_not_answer = {ACTOR}
    tick = len(run.records) + 1
    run.play(lambda: (run.ticks[-1].tick, run.ticks[-1].step) == (tick, THINK + 2))
    newest = run.ticks[-1]
    assert dict(zip(newest.channel, newest.sequence, strict=True))[RIGHT] == tick


def test_early_done_of_a_dead_host_does_not_count() -> None:
    run = robot()
    run.does_not_answer = {ROBOT}
    tick = len(run.records) + 1
    run.play(lambda: run.ticks[-1].tick == tick)
    run.done(ROBOT, tick, THINK, sequence=99)
    run.play(lambda: run.supervisor.loop.barrier.repeated > 0)
    run.end(ROBOT, -9)
    run.does_not_answer = set()
    run.play_ticks(3)
    assert run.supervisor._core.ledger.latest(RIGHT) < 99


def test_done_beyond_the_lookahead_does_not_count() -> None:
    run = robot()
    run.does_not_answer = {ROBOT, ACTOR}
    tick = len(run.records) + 1
    run.play(lambda: run.ticks[-1].tick == tick)
    run.done(ACTOR, tick, THINK + 2)
    run.done(ROBOT, tick, ACQUIRE, sequence=tick)
    run.done(ROBOT, tick, THINK, sequence=tick)
    run.play(lambda: (run.ticks[-1].tick, run.ticks[-1].step) == (tick, THINK + 2))
    run.play(lambda: run.supervisor.loop.barrier.repeated > 3)
    assert len(run.records) == tick - 1

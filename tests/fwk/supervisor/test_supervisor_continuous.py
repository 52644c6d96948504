"""Ticks for continuous components and their dones, without processes."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

from fwk import Component, Reads, Writes
from fwk.bus import sync
from fwk.model.plan import NOBODY
from fwk.model.tick_events import TickTold
from fwk.supervisor.continuous import ContinuousHosts
from fwk.supervisor.host_process import Change
from fwk.supervisor.tick_sender import Tick
from lcmtypes.core import done_t, tick_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t
from tests.fwk.supervisor.memory_run import MemoryRun

PLANS = 1
IMU, POSE = 0, 1


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Plans(Component):
    rate_hz = 5
    imu: Reads[imu_t]
    pose: Writes[pose_t]


class Told:
    """The continuous side of a supervisor in memory; its datagrams are kept."""

    def __init__(self) -> None:
        run = MemoryRun({"r/senses": Senses, "r/plans": Plans})
        core = run.supervisor._core
        self.table, self.ledger = core.hosts, core.ledger
        self.sent: list[tuple[bytes, bytes]] = []
        self.events: list[object] = []
        sender = SimpleNamespace(send=lambda channel, data, _: self.sent.append((channel, data)))
        tick_log = SimpleNamespace(event=self.events.append)
        self.continuous = ContinuousHosts(replace(core, sender=cast(Any, sender)), cast(Any, tick_log))
        for host in self.table:
            host.begin_start(0)
            host.become_ready(0)

    def tell(self, tick: int) -> tick_t:
        self.continuous.tell(Tick(tick, 50_000 * tick, NOBODY))
        made: tick_t = sync.decode_tick(self.sent[-1][1])
        return made

    def take(self, tick: int, number: int, incarnation: int = 1) -> bool:
        done, host = done_t(), self.table[PLANS]
        done.host, done.kind, done.tick, done.iteration = PLANS, done_t.ITERATION, tick, number
        done.incarnation = incarnation
        counts = self.continuous.counts(host, done)
        if counts:
            self.continuous.take(host, done)
        return counts


def test_host_gets_marks_since_its_last_accepted_done() -> None:
    told = Told()
    told.ledger.publish(IMU, 1)
    assert list(told.tell(1).sequence) == [1]
    told.ledger.publish(IMU, 2)
    assert list(told.tell(2).sequence) == [2]
    assert told.take(1, 1)
    assert list(told.tell(3).sequence) == [2]
    assert told.take(3, 1)
    assert list(told.tell(4).sequence) == []
    assert told.events == [TickTold()] * 4


def test_each_done_is_taken_once_and_always_sent_back() -> None:
    told = Told()
    told.tell(1)
    assert [told.take(1, 1), told.take(1, 1), told.take(1, 2), told.take(1, 1)] == [True, False, True, False]
    assert [channel for channel, _ in told.sent] == [sync.TICK, *[sync.TAKEN] * 4]
    assert told.take(2, 1)
    assert told.take(1, 1, incarnation=2)


def test_a_stopped_component_is_informed_later() -> None:
    told = Told()
    host = told.table[PLANS]
    host.ended(-9, 0, stopping=False)
    host.begin_start(0)
    told.continuous.tell(Tick(1, 0, NOBODY))
    assert told.sent == []
    host.become_ready(0)
    told.ledger.publish(IMU, 3)
    assert list(told.tell(2).sequence) == [3]


def test_new_settings_are_sent_until_a_done_is_accepted() -> None:
    told = Told()
    entry = told.table[PLANS]
    told.tell(1)
    entry.changes.append(Change(PLANS, 1, "{}", told.ledger.step + 1))
    assert told.tell(2).n_settings == 1
    assert told.take(1, 1)
    entry.drop_told_changes()
    assert told.tell(3).n_settings == 1
    assert told.take(2, 1)
    entry.drop_told_changes()
    assert told.tell(4).n_settings == 0

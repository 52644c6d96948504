"""What continuous components are told, and how their dones are taken, without processes."""

from types import SimpleNamespace
from typing import Any, cast

from fwk import Component, Reads, Writes
from fwk.bus import sync
from fwk.engine.visibility import Ledger
from fwk.model.plan import NOBODY
from fwk.model.tick_events import TickEvent, TickTold
from fwk.supervisor.continuous import Continuous
from fwk.supervisor.processes.host_process import Change, host_table
from fwk.testing.plans import plan_of
from lcmtypes.core import done_t, tick_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t

SENSES, PLANS = 0, 1
IMU, POSE = 0, 1


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Plans(Component):
    rate_hz = 5
    imu: Reads[imu_t]
    pose: Writes[pose_t]


class Told:
    """A ledger and the continuous side of it; sent messages are kept."""

    def __init__(self) -> None:
        plan = plan_of({"r/senses": Senses, "r/plans": Plans})
        self.table = host_table(plan)
        self.ledger = Ledger(plan)
        self.sent: list[tuple[bytes, bytes]] = []
        self.events: list[TickEvent] = []
        sender = SimpleNamespace(send=lambda channel, data, _: self.sent.append((channel, data)))
        records = SimpleNamespace(event=self.events.append)
        self.continuous = Continuous(plan, 7, self.table, self.ledger, cast(Any, sender), cast(Any, records))
        for entry in self.table:
            entry.starting(0)
            entry.state = "running"

    def tell(self, tick: int) -> tick_t:
        self.continuous.tell(tick, 50_000 * tick, NOBODY)
        made: tick_t = sync.decode_tick(self.sent[-1][1])
        return made

    def take(self, tick: int, number: int, host: int = PLANS, incarnation: int = 1) -> bool:
        done = done_t()
        done.host, done.incarnation, done.kind = host, incarnation, done_t.ITERATION
        done.tick, done.step, done.iteration = tick, -1, number
        return self.continuous.take(self.table[host], done)


def test_it_is_told_what_moved_since_its_last_done_until_that_was_taken() -> None:
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


def test_who_takes_part_in_stages_is_told_nothing_here() -> None:
    told = Told()
    assert not told.take(1, 1, host=SENSES)
    assert told.sent == []


def test_who_does_not_run_is_told_later() -> None:
    told = Told()
    told.table[PLANS].state = "starting"
    told.continuous.tell(1, 0, NOBODY)
    assert told.sent == []
    told.table[PLANS].state = "running"
    told.ledger.publish(IMU, 3)
    assert list(told.tell(2).sequence) == [3]


def test_new_settings_are_told_until_a_done_of_that_tick_was_taken() -> None:
    told = Told()
    entry = told.table[PLANS]
    told.tell(1)
    entry.changes.append(Change(PLANS, 1, "{}", told.ledger.step + 1))
    assert told.tell(2).n_settings == 1
    assert told.take(1, 1)
    entry.told()
    assert told.tell(3).n_settings == 1
    assert told.take(2, 1)
    entry.told()
    assert told.tell(4).n_settings == 0

"""Hosts without processes: ticks and messages in, messages and dones out."""

from typing import Any, Literal

import pytest

from fwk import Blackboard, Component, Reads, Writes
from fwk.engine.assignment import Assignment, Start
from fwk.engine.failures import ComponentFailedError
from fwk.engine.visibility import Visibility
from fwk.host.memory_host import MemoryHost
from fwk.lcm.messages import fingerprint
from fwk.model.channel_table import ChannelTable, Fact, OpenChannel, change_message
from fwk.model.plan import Plan
from fwk.testing.plans import plan_of
from lcmtypes.core import done_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t

THINK = 5
READER = 1
"""Index of the component under test, and of its host."""


class Sensor(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


class Counter(Component):
    """Reports how many messages it saw and the newest one; fails if that is negative."""

    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.x_m = float(len(self.imu.fresh))
        self.pose.value.y_m = self.imu.value.heading_rad
        if self.pose.value.y_m < 0:
            raise ValueError("heading")
        self.pose.write()

    def finalize(self) -> None:
        self.pose.value.x_m = -1.0
        self.pose.write()


class Reader(Counter):
    stage = "think"


class SteadyReader(Counter):
    rate_hz = 100.0


class Opener(Component):
    """Opens the channel of the sensor, and again when told to close it."""

    stage = "think"
    blackboard: Blackboard
    pose: Writes[pose_t]

    def init(self) -> None:
        self.imu = self.blackboard.open_for_reading(imu_t, "imu")

    def reopen(self) -> None:
        self.blackboard.close(self.imu)
        self.imu = self.blackboard.open_for_reading(imu_t, "imu")

    def loop(self) -> None:
        self.pose.value.x_m = float(len(self.imu.fresh))
        self.pose.value.y_m = self.imu.value.heading_rad
        self.pose.write()


class Told:
    """A host in memory with the marks of its run."""

    def __init__(self, component: type[Component], incarnation: int = 1) -> None:
        self.plan: Plan = plan_of({"r/sensor": Sensor, "r/reader": component})
        self.ledger = Visibility(self.plan)
        self.channels = {channel.name: channel.index for channel in self.plan.channels}
        start = Start(incarnation, {"r/pose": 40} if incarnation > 1 else {}, {})
        self.host = MemoryHost(Assignment(self.plan, READER, 7, start, {}), self.ledger)
        self.host.init()
        self.table = ChannelTable(self.plan)
        self.newest: dict[int, bytes] = {}

    def sense(self, *headings_rad: float) -> None:
        """Publishes messages of the sensor, visible from the next tick on."""
        index = self.channels["r/imu"]
        for heading_rad in headings_rad:
            message = imu_t()
            message.heading_rad = heading_rad
            message.header.sequence = self.ledger.latest(index) + 1
            self.ledger.publish(index, message.header.sequence)
            self.newest[index] = bytes(message.encode())
            self.host.put(index, self.newest[index])

    def tick(self, number: int) -> tuple[float, float]:
        """Runs a tick; returns how many messages the reader saw, and the newest heading."""
        self.ledger.begin()
        written, _ = self.host.tick(self.host.compose(number, 3, number * 50_000, -1), THINK)
        return seen(written)


def seen(written: list[tuple[str, bytes]]) -> tuple[float, float]:
    ((channel, data),) = written
    assert channel == "r/pose"
    pose: Any = pose_t.decode(data)
    return pose.x_m, pose.y_m


def test_host_runs_iteration_on_visible_messages_alone() -> None:
    told = Told(Reader)
    told.sense(1.0, 2.0)
    told.ledger.begin()
    tick = told.host.compose(1, 3, 50_000, -1)
    told.sense(3.0)  # arrived, but not visible
    written, done = told.host.tick(tick, THINK)
    assert seen(written) == (2.0, 2.0)
    assert (done.kind, done.tick, done.step, done.host) == (done_t.STAGE, 1, 3, READER)
    assert dict(zip(done.channel, done.sequence, strict=True)) == {told.channels["r/pose"]: 1}
    assert told.tick(2) == (1.0, 3.0)


def test_headers_carry_tick_step_and_incarnation() -> None:
    told = Told(Reader, incarnation=3)
    told.ledger.begin()
    ((_, data),), _ = told.host.tick(told.host.compose(9, 4, 450_000, -1), THINK)
    header = pose_t.decode(data).header
    assert (header.tick, header.stage, header.sequence, header.time_us) == (9, 4, 41, 450_000)
    assert header.writer == "r/reader#3"


def test_restarted_host_sees_newest_message_only() -> None:
    told = Told(Reader, incarnation=2)
    told.sense(1.0, 2.0, 3.0)
    assert told.tick(5) == (1.0, 3.0)
    told.sense(4.0, 5.0)
    assert told.tick(6) == (2.0, 5.0)


def test_message_that_cannot_be_fetched_is_reported_as_lost() -> None:
    told = Told(Reader)
    told.sense(1.0, 2.0, 3.0)
    told.host.lose(told.channels["r/imu"], 2)
    told.ledger.begin()
    written, done = told.host.tick(told.host.compose(1, 3, 0, -1), THINK)
    assert seen(written) == (2.0, 3.0)
    assert [(lost.channel, lost.sequence) for lost in done.lost] == [(told.channels["r/imu"], 2)]


def test_message_that_came_early_can_still_be_lost() -> None:
    told = Told(Reader)
    told.sense(1.0)
    told.ledger.begin()
    tick = told.host.compose(1, 3, 50_000, -1)
    told.sense(2.0, 3.0)  # not visible, but the host takes them from the socket while it looks for the first
    told.host.lose(told.channels["r/imu"], 1)
    told.host.tick(tick, THINK)
    told.host.lose(told.channels["r/imu"], 2)
    told.ledger.begin()
    written, done = told.host.tick(told.host.compose(2, 3, 100_000, -1), THINK)
    assert seen(written) == (1.0, 3.0)
    assert [(lost.channel, lost.sequence) for lost in done.lost] == [(told.channels["r/imu"], 2)]


def test_exception_in_loop_names_component_and_sends_nothing() -> None:
    told = Told(Reader)
    told.sense(-1.0)
    with pytest.raises(ComponentFailedError, match=r"r/reader: ValueError: heading .*in loop, tick 1"):
        told.tick(1)


def test_final_done_follows_messages_of_finalize() -> None:
    told = Told(Reader)
    told.tick(1)
    written, done = told.host.finalize()
    assert seen(written) == (-1.0, 0.0)
    assert (done.kind, done.tick, list(done.sequence)) == (done_t.FINAL, 1, [2])


def test_continuous_host_iterates_once_on_the_newest_marks() -> None:
    told = Told(SteadyReader)
    for tick, heading_rad in ((1, 1.0), (2, 2.0)):
        told.sense(heading_rad)
        told.ledger.begin()
        told.host.tell(told.host.compose(tick, 0, tick * 50_000, -1))
    for number, expected in ((1, (1.0, 2.0)), (2, (0.0, 2.0))):
        written, done = told.host.iterate()
        assert seen(written) == expected
        assert (done.kind, done.tick, done.iteration) == (done_t.ITERATION, 2, number)


def fact(told: Told, kind: Literal["read", "close"], handle: int) -> Fact:
    index, name = told.channels["r/imu"], fingerprint(imu_t).hex()
    return Fact(kind, READER, handle, OpenChannel(READER, handle, index, "r/imu", "robot.imu_t", name))


def decide(told: Told, number: int, *facts: Fact) -> None:
    """Decides about channels at a boundary."""
    told.table.apply(facts)
    told.ledger.opened(told.table)
    told.host.decide(change_message(number, facts), told.newest)


def test_newly_read_channel_begins_with_newest_message() -> None:
    told = Told(Opener)
    told.sense(1.0, 2.0)
    told.ledger.begin()
    decide(told, 1, fact(told, "read", 1))
    assert told.tick(1) == (1.0, 2.0)
    told.sense(3.0, 4.0)
    assert told.tick(2) == (2.0, 4.0)


def test_channel_closed_and_read_again_begins_with_newest() -> None:
    told = Told(Opener)
    told.sense(1.0)
    told.ledger.begin()
    decide(told, 1, fact(told, "read", 1))
    assert told.tick(1) == (1.0, 1.0)
    told.host.runners["r/reader"].component.reopen()  # type: ignore[attr-defined]
    decide(told, 2, fact(told, "close", 1), fact(told, "read", 2))
    told.sense(2.0, 3.0)  # between the decision and the tick that carries it
    assert told.tick(2) == (1.0, 3.0)

"""The blackboard aspect as a component sees it, on a bench and in a system in memory."""

import gc
import weakref
from typing import Any

import pytest

from fwk import Blackboard, Clock, Component, NotOpenError, Reads, Writes
from fwk.lcm import envelope
from fwk.testing.bench import Bench
from fwk.testing.memory import MemorySystem
from lcmtypes.core import header_t
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import obstacle_t


class Opener(Component):
    stage = "think"
    blackboard: Blackboard
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1
        self.imu.write()


class Watcher(Component):
    stage = "act"
    blackboard: Blackboard


class Reader(Component):
    stage = "act"
    blackboard: Blackboard
    imu: Reads[imu_t]


def bench() -> Bench:
    return Bench(Opener, "a/opener")


def test_requested_channels_are_open_from_the_next_tick_on() -> None:
    made = bench()
    spot = made.component.blackboard.open_for_writing(imu_t, "spot")
    with pytest.raises(NotOpenError, match="a/spot is not open for writing; check 'is_open' first"):
        spot.write()
    made.iterate(2)
    assert spot.is_open
    spot.value.heading_rad = 3.0
    spot.write()
    made.iterate()
    assert [message.heading_rad for message in made.opened("spot").sent] == [3.0]


def test_a_reader_opened_at_run_time_shows_messages_and_closes() -> None:
    made = bench()
    reader = made.component.blackboard.open_for_reading(imu_t, "b/imu")
    assert made.component.blackboard.open_for_reading(imu_t, "b/imu") is reader
    made.iterate(2)
    made.opened("b/imu").put(heading_rad=1.0)
    made.iterate()
    assert (reader.refreshed, reader.value.heading_rad) == (True, 1.0)
    made.component.blackboard.close(reader)
    made.iterate(2)
    made.opened("b/imu").put(heading_rad=2.0)
    made.iterate()
    assert reader.value.heading_rad == 1.0
    with pytest.raises(
        ValueError, match="a/opener: this channel was not opened by this component, or is already closed"
    ):
        made.component.blackboard.close(reader)


def test_declared_channels_are_given_and_cannot_be_closed() -> None:
    made = Bench(Reader, "a/reader")
    board = made.component.blackboard
    assert board.open_for_reading(imu_t, "imu") is made.component.imu
    with pytest.raises(ValueError, match="not opened by this component"):
        board.close(made.component.imu)


@pytest.mark.parametrize(
    ("kind", "name", "what"),
    [
        (imu_t, "a/ball!", "'a/ball!' is not a valid name"),
        (imu_t, "fwk/tick", "names that begin with 'fwk/' are the framework's own"),
        (int, "a/ball", "is not an LCM type; import it from lcmtypes"),
        (header_t, "a/ball", "core.header_t belongs to the framework and does not begin with 'core.header_t header;'"),
    ],
)
def test_channels_that_can_never_open_are_refused_at_once(kind: type, name: str, what: str) -> None:
    with pytest.raises(ValueError, match=f"a/opener: .*{what}"):
        bench().component.blackboard.open_for_reading(kind, name)


def test_an_iteration_with_too_many_requests_is_refused() -> None:
    board = bench().component.blackboard
    for number in range(64):
        board.open_for_reading(imu_t, f"a/imu{number}")
    with pytest.raises(ValueError, match="more than 64 channels opened and closed in one iteration"):
        board.open_for_reading(imu_t, "a/more")


def test_closed_channel_is_not_written_before_the_grant() -> None:
    class Twice(Component):
        stage = ("think", "act")
        blackboard: Blackboard
        clock: Clock

        def init(self) -> None:
            self.spot = self.blackboard.open_for_writing(imu_t, "spot")

        def loop(self) -> None:
            if self.clock.tick == 2 and self.clock.stage == "think":
                self.blackboard.close(self.spot)
            if self.spot.is_open:
                self.spot.write()

    system = MemorySystem({"a/twice": Twice, "b/opener": Opener})
    system.tick(2)
    assert system.runners["b/opener"].component.blackboard.writer("a/spot") == "a/twice"  # type: ignore[attr-defined]
    system.tick(2)
    assert [(imu.header.tick, imu.header.stage) for imu in map(imu_t.decode, system.sent["a/spot"])] == [(2, 5)]


def test_a_channel_closed_before_it_was_open_never_opens() -> None:
    made = bench()
    board = made.component.blackboard
    spot = board.open_for_writing(imu_t, "spot")
    board.close(spot)
    made.iterate(3)
    assert (spot.is_open, spot.refused) == (False, "")
    again = board.open_for_writing(imu_t, "spot")
    made.iterate(2)
    assert again.is_open


def test_channel_reopened_with_another_type_suits_each_reader() -> None:
    system = MemorySystem({"a/opener": Opener, "b/opener": Opener})
    system.tick()
    a, b = (system.runners[f"{name}/opener"].component.blackboard for name in "ab")  # type: ignore[attr-defined]
    for kind in (imu_t, obstacle_t, imu_t):  # the type of the second channel has no header
        writer, reader = a.open_for_writing(kind, "/SPOT"), b.open_for_reading(kind, "/SPOT")
        system.tick(2)
        writer.write()
        system.tick(2)
        assert (reader.message_type, reader.header.writer, reader.has_value) == (kind, "a/opener", True)
        a.close(writer)
        b.close(reader)
        system.tick(2)
    assert [data[:8] for data in system.sent["SPOT"]] == [
        envelope.fingerprint(kind) for kind in (imu_t, obstacle_t, imu_t)
    ]


def test_reader_opened_at_run_time_keeps_the_longest_history() -> None:
    system = MemorySystem({"a/opener": Opener, "b/reader": Watcher})
    system.tick(3)
    board = system.runners["b/reader"].component.blackboard  # type: ignore[attr-defined]
    few = board.open_for_reading(imu_t, "a/imu", history=2)
    system.tick(5)
    assert [imu.heading_rad for imu in few.history] == [7.0, 8.0]
    many = board.open_multiple_for_reading(imu_t, "*/imu", history=3)
    system.tick(6)
    assert many["a/imu"] is few
    assert [imu.heading_rad for imu in few.history] == [12.0, 13.0, 14.0]
    with pytest.raises(ValueError, match="b/reader: history=-1: a history has at least 1 message"):
        board.open_for_reading(imu_t, "a/imu", history=-1)


def test_a_continuous_component_opens_channels_too() -> None:
    class Roamer(Component):
        rate_hz = 10.0
        blackboard: Blackboard

        def init(self) -> None:
            self.imu = self.blackboard.open_for_reading(imu_t, "a/imu")
            self.seen = self.blackboard.open_for_writing(odometry_t, "seen")

        def loop(self) -> None:
            if self.seen.is_open:
                self.seen.value.x_m = len(self.imu.fresh)
                self.seen.write()

    system = MemorySystem({"a/opener": Opener, "a/roamer": Roamer})
    system.tick(7)
    seen = [odometry_t.decode(data) for data in system.sent["a/seen"]]
    assert [(each.header.tick, each.x_m) for each in seen] == [(3, 1.0), (5, 2.0), (7, 2.0)]


def test_late_opener_has_the_newest_value_at_once() -> None:
    system = MemorySystem({"a/opener": Opener, "a/reader": Reader, "b/opener": Opener})
    system.tick(5)
    a, b = (system.runners[f"{name}/opener"].component.blackboard for name in "ab")  # type: ignore[attr-defined]
    reader = a.open_for_reading(imu_t, "b/imu")
    many = a.open_multiple_for_reading(imu_t, "*/spot")
    spot = b.open_for_writing(imu_t, "spot")
    system.tick(2)
    assert [message.header.sequence for message in reader.fresh] == [6]
    assert list(many) == ["b/spot"]
    assert [(event.kind, event.channel) for event in a.events_of("b/*")] == [
        ("reader_added", "b/imu"),
        ("instance_created", "b/spot"),
        ("writer_added", "b/spot"),
        ("reader_added", "b/spot"),
    ]
    assert (b.readers("imu"), b.writer("imu"), b.has_writer("x/none")) == (("a/opener",), "b/opener", False)
    assert [(each.name, each.writer, each.declared) for each in a.instances("*/spot")] == [
        ("b/spot", "b/opener", False)
    ]
    spot.write()
    b.close(spot)
    system.tick(2)
    assert not many
    assert not spot.is_open
    refused = b.open_for_reading(odometry_t, "a/imu")
    system.tick(2)
    assert "b/opener wants it as robot.odometry_t" in refused.refused


def test_closed_and_refused_channels_take_no_memory() -> None:
    class Restless(Component):
        stage = "think"
        blackboard: Blackboard

        def init(self) -> None:
            self.asked: list[Any] = []
            self.kept: list[weakref.ref[Any]] = []

        def loop(self) -> None:
            for handle in self.asked:
                if not getattr(handle, "refused", ""):
                    self.blackboard.close(handle)
            self.asked = [
                self.blackboard.open_for_reading(imu_t, "r/other"),
                self.blackboard.open_for_writing(imu_t, "own"),
                self.blackboard.open_for_writing(odometry_t, "own"),  # of another type: refused
                self.blackboard.open_for_writing(imu_t, f"own{len(self.kept)}"),  # soon no spare channel is left
                self.blackboard.open_multiple_for_reading(imu_t, "*/own"),
                self.blackboard.open_multiple_for_reading(odometry_t, "*/nothing"),
            ]
            self.kept += map(weakref.ref, self.asked)

    bench = Bench(Restless, name="r/restless")
    bench.iterate(100)
    gc.collect()
    assert len({id(each()) for each in bench.component.kept if each() is not None}) <= 2 * 6

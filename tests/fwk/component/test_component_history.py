"""Readers that keep the newest messages of a channel."""

from typing import Any

import pytest

from fwk import Component, Each, Reads, Writes, channel
from fwk.component.declaration import declaration
from fwk.component.port import DeclarationError
from fwk.testing import Bench, MemorySystem
from lcmtypes.robot import imu_t


class Remembers(Component):
    stage = "think"
    imu: Reads[imu_t] = channel(history=3)
    plain: Reads[imu_t]
    others: Each[Reads[imu_t]] = channel("imu", history=2)
    seen: Writes[imu_t]

    def loop(self) -> None:
        self.seen.value.heading_rad = sum(each.heading_rad for each in self.imu.history)
        self.seen.write()


def headings(port: Any) -> list[float]:
    return [each.heading_rad for each in port.history]


@pytest.fixture
def bench() -> Bench:
    return Bench(Remembers, namespaces=("a", "b"))


def test_the_newest_are_kept_oldest_first(bench: Bench) -> None:
    reader = bench.component.imu
    bench.iterate()
    assert headings(reader) == []
    assert reader.value.heading_rad == 0.0
    for number in range(1, 6):
        bench.port("imu").put(heading_rad=float(number))
        if number in (2, 5):
            bench.iterate()
            assert headings(reader) == [[1.0, 2.0], [3.0, 4.0, 5.0]][number == 5]
    assert (reader.value.heading_rad, reader.history[0].heading_rad, len(reader.history)) == (5.0, 3.0, 3)
    assert [each.heading_rad for each in reader.history[-2:]] == [4.0, 5.0]
    assert [each.heading_rad for each in reader.fresh] == [3.0, 4.0, 5.0]
    bench.iterate()
    assert headings(reader) == [3.0, 4.0, 5.0]
    assert not reader.refreshed
    with pytest.raises(IndexError):
        reader.history[3]


def test_each_message_is_decoded_once_and_on_first_access(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    decoded: list[bytes] = []
    history = bench.component.imu.history
    decode = history._decode

    def counted(data: bytes) -> Any:
        decoded.append(data)
        return decode(data)

    monkeypatch.setattr(history, "_decode", counted)
    monkeypatch.setattr(bench.component, "loop", lambda: None)
    for number in range(3):
        bench.port("imu").put(heading_rad=float(number))
    bench.iterate()
    assert decoded == []
    assert bench.component.imu.value is bench.component.imu.history[-1]
    assert len(decoded) == 1
    headings(bench.component.imu)
    headings(bench.component.imu)
    assert len(decoded) == 3


def test_history_without_length_keeps_the_newest_of_each(bench: Bench) -> None:
    for number in range(4):
        bench.port("plain").put(heading_rad=float(number))
        bench.port("others", "b").put(heading_rad=10.0 + number)
    bench.iterate()
    assert headings(bench.component.plain) == [3.0]
    assert headings(bench.component.others["a"]) == []
    assert headings(bench.component.others["b"]) == [12.0, 13.0]


class Counts(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1.0
        self.imu.write()


class TwoPorts(Component):
    stage = "act"
    short: Reads[imu_t] = channel("imu", history=1)
    long: Reads[imu_t] = channel("imu", history=4)
    none: Reads[imu_t] = channel("imu")


def test_ports_of_one_channel_share_the_longest() -> None:
    system = MemorySystem({"r/counts": Counts, "r/two": TwoPorts})
    system.tick(6)
    component: Any = system.runners["r/two"].component
    assert headings(component.short) == headings(component.long) == headings(component.none) == [3.0, 4.0, 5.0, 6.0]


@pytest.mark.parametrize(
    ("length", "kind", "error"),
    [
        (-1, Reads[imu_t], "Wrong.imu: history=-1: a history has at least 1 message"),
        (2, Writes[imu_t], "Wrong.imu: history=2: only Reads keeps a history"),
    ],
)
def test_an_impossible_history_is_refused(length: int, kind: Any, error: str) -> None:
    made = type("Wrong", (Component,), {"stage": "think", "imu": channel(history=length)})
    made.__annotations__ = {"imu": kind}
    with pytest.raises(DeclarationError, match=error):
        declaration(made)

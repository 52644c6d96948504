"""Components that iterate in every k-th tick: their ticks, their inputs, and equal bytes in every driver."""

from typing import Any

import pytest

from fwk import Clock, Component, Each, Reads, Writes, channel
from fwk.testing import Bench, MemorySystem
from lcmtypes.robot import imu_t, odometry_t


class Ticker(Component):
    """Writes the number of each tick."""

    stage = "sensor_acquire"
    clock: Clock
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad = float(self.clock.tick)
        self.imu.write()


class Third(Component):
    """Sums up the messages since its last iteration."""

    stage = "think"
    every = 3
    offset = 2
    clock: Clock
    ticks: Each[Reads[imu_t]] = channel("*/imu")
    odometry: Writes[odometry_t]

    def init(self) -> None:
        self.odometry.value.y_m = -1.0

    def loop(self) -> None:
        self.odometry.value.x_m = sum(each.heading_rad for reader in self.ticks.values() for each in reader.fresh)
        self.odometry.value.y_m = float(self.clock.every)
        self.odometry.write()

    def finalize(self) -> None:
        self.odometry.write()


class Often(Third):
    every = 40
    offset = 0


def written(system: MemorySystem, name: str = "r/odometry") -> list[tuple[int, float]]:
    """Returns tick and sum of each message."""
    decoded = [odometry_t.decode(data) for data in system.sent[name]]
    return [(message.header.tick, message.x_m) for message in decoded]


def test_an_iteration_needs_matching_tick_and_offset() -> None:
    system = MemorySystem({"r/ticker": Ticker, "r/third": Third})
    system.tick(9)
    assert written(system) == [(2, 1.0 + 2.0), (5, 3.0 + 4.0 + 5.0), (8, 6.0 + 7.0 + 8.0)]


def test_ticks_between_are_not_an_absence() -> None:
    """A component sees all messages between two of its iterations, even of more than 16 ticks."""
    system = MemorySystem({"r/ticker": Ticker, "r/often": Often})
    system.tick(80)
    assert written(system) == [(40, sum(range(1, 41))), (80, sum(range(41, 81)))]


@pytest.mark.parametrize(("turns", "ticks"), [((1, 0), [1, 2, 3, 4]), ((2, 0), [2, 4]), ((2, 7), [1, 3])])
def test_every_of_a_plan_replaces_that_of_the_class(turns: tuple[int, int], ticks: list[int]) -> None:
    system = MemorySystem({"r/ticker": Ticker, "r/third": Third}, turns={"r/third": turns})
    system.tick(4)
    assert [tick for tick, _ in written(system)] == ticks


def test_on_the_bench_messages_wait_for_the_iteration() -> None:
    bench = Bench(Third, namespaces=("r",))
    for tick in range(1, 6):
        bench.port("ticks", "r").put(heading_rad=float(tick))
        bench.iterate()
    assert [(sent.header.tick, sent.x_m, sent.y_m) for sent in bench.odometry.sent] == [(2, 3.0, 3.0), (5, 12.0, 3.0)]
    bench.iterate()
    bench.finalize()
    assert bench.odometry.sent[-1].header.tick == 6


def test_the_bench_takes_every_and_offset_as_arguments() -> None:
    bench = Bench(Third, namespaces=("r",), every=2, offset=1)
    bench.iterate(4)
    assert [sent.header.tick for sent in bench.odometry.sent] == [1, 3]
    everything: Any = bench.component.clock.every
    assert everything == 2

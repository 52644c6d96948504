"""Continuous components on the bench and in a system in memory."""

from fwk import Clock, Component, Reads, Writes, channel
from fwk.testing import Bench
from fwk.testing.memory import MemorySystem
from lcmtypes.robot import imu_t


class Counts(Component):
    stage = "think"
    imu: Writes[imu_t]
    heard: Reads[imu_t] = channel("r/slow")

    def loop(self) -> None:
        self.imu.value.heading_rad = self.heard.header.sequence
        self.imu.write()


class Slow(Component):
    rate_hz = 10
    clock: Clock
    slow: Writes[imu_t]
    imu: Reads[imu_t]

    def loop(self) -> None:
        self.slow.value.heading_rad = len(self.imu.fresh)
        self.slow.write()


def test_on_the_bench_a_continuous_component_iterates() -> None:
    bench = Bench(Slow)
    bench.port("imu").put()
    bench.port("imu").put()
    bench.iterate()
    assert bench.port("slow").sent[-1].heading_rad == 2


def test_continuous_rate_counts_logical_time_in_memory() -> None:
    system = MemorySystem({"r/counts": Counts, "r/slow": Slow})
    system.tick(7)
    slow = [imu_t.decode(data) for data in system.sent["r/slow"]]
    assert [(imu.header.tick, imu.header.stage, imu.heading_rad) for imu in slow] == [
        (1, 1, 0),
        (3, 1, 2),
        (5, 1, 2),
        (7, 1, 2),
    ]
    assert [imu_t.decode(data).heading_rad for data in system.sent["r/imu"]] == [0, 1, 1, 2, 2, 3, 3]

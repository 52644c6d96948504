"""The benchmark of the console: what it makes of its windows."""

from tools.bench.console import Ratios, Window


def test_ratios_are_the_medians_of_pairs() -> None:
    alone = Window(ticks=100, wall_us=1e6, cpu_us=2e6)
    beside = [Window(ticks=50, wall_us=factor * 0.5e6, cpu_us=factor * 1e6) for factor in (1.02, 1.5, 1.01)]
    found = Ratios.of([(each, alone) for each in beside])
    assert (round(found.cpu, 6), round(found.wall, 6)) == (1.02, 1.02)

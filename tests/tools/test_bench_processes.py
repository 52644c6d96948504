"""CPU time by process."""

import pytest

from tools.bench.processes import cpu_ms

pytestmark = pytest.mark.system


def test_every_process_of_a_launch_file_has_its_cpu_time() -> None:
    spent, tick_ms = cpu_ms("soccer-1v1.yaml", ticks=20, hosting="process", warm_up=5)
    assert {"supervisor", "gateway", "simulator", "navigator"} < set(spent)
    assert all(each.processes >= 1 and each.total_ms >= 0 for each in spent.values())
    assert spent["supervisor"].total_ms > 0
    assert tick_ms > 0

"""CPU time by component."""

from tools.bench.components import FRAMEWORK, cpu_ms


def test_every_component_of_a_launch_file_has_its_cpu_time() -> None:
    found = cpu_ms("soccer-truth.yaml", ticks=2, warm_up=0)
    assert {"simulator", "world_model", "agent", FRAMEWORK} <= set(found)
    assert all(total_ms > 0 for total_ms in found.values())
    assert list(found.values()) == sorted(found.values(), reverse=True)

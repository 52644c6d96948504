"""The data flow that all peers share."""

from pathlib import Path

import pytest

from tools.bench.dora_flow import dataflow
from tools.bench.scenarios import growth, variations
from tools.bench.shape import Shape


def test_components_are_spread_over_the_stages() -> None:
    shape = Shape(components=7, stages=5)
    assert [shape.members(stage) for stage in range(5)] == [[0, 5], [1, 6], [2], [3], [4]]
    assert [shape.stage(component) for component in range(7)] == [0, 1, 2, 3, 4, 0, 1]


def test_a_component_reads_those_before_it_round_the_ring() -> None:
    shape = Shape(components=20, reads=3)
    assert shape.sources(5) == [4, 3, 2]
    assert shape.sources(0) == [19, 18, 17]


@pytest.mark.parametrize("reads", [1, 3, 10])
@pytest.mark.parametrize("components", [2, 5, 20])
def test_no_component_reads_itself_and_readers_mirror_sources(components: int, reads: int) -> None:
    shape = Shape(components, reads=reads)
    for component in range(components):
        assert component not in shape.sources(component)
        assert len(set(shape.sources(component))) == min(reads, components - 1)
        assert all(component in shape.sources(reader) for reader in shape.readers(component))
    assert sum(len(shape.readers(each)) for each in range(components)) == components * min(reads, components - 1)


def test_a_source_of_an_earlier_stage_is_seen_in_the_same_tick() -> None:
    shape = Shape(components=20)
    assert shape.expected_tick(6, 5, 100) == 100  # stage 1 reads stage 0
    assert shape.expected_tick(5, 4, 100) == 99  # stage 0 reads stage 4 of the tick before
    assert shape.expected_tick(6, 1, 100) == 99  # both in stage 1


def test_a_saved_shape_is_read_back_unchanged(tmp_path: Path) -> None:
    shape = Shape(20, reads=10, padding_bytes=65536, folder=str(tmp_path))
    assert Shape.read(shape.save()) == shape


def test_only_the_growth_scenarios_are_plain() -> None:
    assert [scenario.is_plain for scenario in growth((5, 160))] == [True, True]
    assert not any(scenario.is_plain for scenario in variations((20,)))
    names = [scenario.name for scenario in [*growth(), *variations()]]
    assert len(set(names)) == len(names)


def test_more_components_get_fewer_ticks_down_to_a_minimum() -> None:
    ticks = [scenario.ticks for scenario in growth((5, 40, 160, 1000))]
    assert ticks == sorted(ticks, reverse=True)
    assert ticks[0] == 500
    assert ticks[-1] == 50


def test_dora_dataflow_closes_the_ring() -> None:
    shape = Shape(components=6, reads=2)
    nodes = {node["id"]: node for node in dataflow(shape, "shape.json")["nodes"]}
    offered = {f"{name}/{output}" for name, node in nodes.items() for output in node["outputs"]}
    assert {wanted for node in nodes.values() for wanted in node["inputs"].values()} == offered
    assert nodes["c3"]["inputs"] == {"tick": "supervisor/tick3", "data2": "c2/data", "data1": "c1/data"}

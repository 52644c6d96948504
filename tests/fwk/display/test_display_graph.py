"""The graph of a system: columns, connections and the forms in which it is written."""

import xml.etree.ElementTree as Xml
from collections.abc import Callable

import pytest

from fwk import Component, Reads, Writes
from fwk.display.graph import Graph, graph, graph_of
from fwk.display.graph_svg import svg
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t, odometry_t

SVG = "{http://www.w3.org/2000/svg}"


class Simulator(Component):
    stage = "pre_loop"


class Sensor(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]
    wish: Reads[odometry_t]


class Thinker(Component):
    stage = "think"
    imu: Reads[imu_t]
    odometry: Writes[odometry_t]


class Free(Component):
    rate_hz = 20.0
    odometry: Reads[odometry_t]
    gyro: Writes[imu_t]


@pytest.fixture
def made() -> Graph:
    plan = plan_of(
        {"a/sensor": Sensor, "a/thinker": Thinker, "a/free": Free, "a/simulator": Simulator},
        outside={"a/wish": "robot.odometry_t"},
    )
    return graph_of(plan)


def test_columns_are_the_stages_that_have_components(made: Graph) -> None:
    assert made.columns == ("outside", "pre_loop", "sensor_acquire", "think", "continuous")
    assert [node.name for node in made.column("sensor_acquire")] == ["a/sensor"]
    assert [node.name for node in made.column("outside")] == ["programs outside"]


def test_edges_lead_from_writers_to_readers(made: Graph) -> None:
    assert {(each.writer, each.reader, each.channel) for each in made.edges} == {
        ("a/sensor", "a/thinker", "a/imu"),
        ("a/thinker", "a/free", "a/odometry"),
        ("programs outside", "a/sensor", "a/wish"),
    }


def test_text_names_the_channels_of_each_component(made: Graph) -> None:
    lines = list(made.lines())
    place = lines.index("  a/thinker")
    assert lines[place + 1 : place + 3] == ["    <- a/imu from a/sensor", "    -> a/odometry"]
    place = lines.index("  a/free")
    assert lines[place + 1 : place + 3] == ["    <- a/odometry from a/thinker", "    -> a/gyro (no reader)"]
    assert made.around(["a/free"]).unread == made.unread
    assert made.around(["a/sensor"]).unread == ()


def test_part_has_the_chosen_components_and_their_neighbours(made: Graph) -> None:
    part = made.around(["a/think*"])
    assert [node.name for node in part.nodes] == ["a/sensor", "a/thinker", "a/free"]
    assert part.columns == ("sensor_acquire", "think", "continuous")


def test_states_and_rates_of_a_run_are_shown() -> None:
    components = [
        {"name": "x", "stages": ["think"], "state": "running"},
        {"name": "y", "stages": [], "state": "failed"},
    ]
    channels = [{"channel": "x/c", "type": "robot.imu_t", "writer": "x", "readers": ["y"], "rate_hz": 19.96}]
    live = graph("run", ["think"], components, channels)
    assert "  y (failed)" in live.lines()
    assert "    <- x/c 20.0 Hz from x" in live.lines()
    (failed,) = [each for each in Xml.fromstring(svg(live)).iter(f"{SVG}g") if each.get("class") == "failed"]
    assert failed.findtext(f"{SVG}text") == "y"
    (rate,) = [each for each in Xml.fromstring(svg(live)).iter(f"{SVG}text") if each.get("class") == "rate"]
    assert rate.text == "c 20.0 Hz"


def test_mermaid_has_every_node_and_edge(made: Graph) -> None:
    lines = list(made.mermaid())
    assert lines[0] == "flowchart LR"
    assert sum("-->" in line for line in lines) == len(made.edges)
    assert sum("subgraph" in line for line in lines) == len(made.columns)


@pytest.mark.parametrize("form", [svg, lambda made: "\n".join(made.mermaid()), lambda made: "\n".join(made.lines())])
def test_every_form_has_channels_with_one_end(form: Callable[[Graph], str], made: Graph) -> None:
    assert "a/gyro" in form(made)
    components = [{"name": "x", "stages": ["think"], "state": "running"}]
    alone = {"channel": "y/alone", "type": "robot.imu_t", "writer": "programs outside", "readers": []}
    assert "y/alone" in form(graph("run", ["think"], components, [alone]))
    row = {"channel": "x/lost", "type": "robot.imu_t", "writer": "", "readers": ["x"], "rate_hz": 0.0}
    left = graph("run", ["think"], components, [row])
    assert "x/lost 0.0 Hz" in form(left)
    assert "x/lost 0.0 Hz" in form(left.around(["x"]))


def boxes(made: Graph) -> list[str]:
    return [str(each.findtext(f"{SVG}text")) for each in Xml.fromstring(svg(made)).iter(f"{SVG}g")]


def test_drawing_has_a_box_for_each_node_and_curves(made: Graph) -> None:
    assert sorted(boxes(made)) == sorted(node.name for node in made.nodes)
    assert len(list(Xml.fromstring(svg(made)).iter(f"{SVG}path"))) == 3


@pytest.mark.parametrize("form", [svg, lambda made: "\n".join(made.mermaid())])
def test_names_never_become_markup(form: Callable[[Graph], str]) -> None:
    name = '<script>"&'
    hostile = graph(name, ["think"], [{"name": name, "stages": ["think"], "state": ""}], [])
    assert "<script>" not in form(hostile)

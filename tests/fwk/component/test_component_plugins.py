"""Plugin requests: names are checked at once, everything else between two ticks."""

import pytest

from fwk import Component, PluginControl
from fwk.testing.bench import Bench
from fwk.testing.memory import MemorySystem


class Director(Component):
    stage = "think"
    plugins: PluginControl

    def loop(self) -> None:
        self.plugins.stop("r/one", "r/two")
        self.plugins.load("r/three")


def test_requests_of_an_iteration_are_taken_once() -> None:
    bench = Bench(Director)
    bench.iterate()
    assert bench.runner.requests() == {"plugins": [("stop", ("r/one", "r/two")), ("load", ("r/three",))]}
    assert bench.runner.requests() == {}


def test_names_that_do_not_exist_are_refused_at_once() -> None:
    plugins = PluginControl("r/director", ["r/director", "r/one"])
    with pytest.raises(ValueError, match=r"r/director: no component 'r/oen'; did you mean 'r/one'\?"):
        plugins.start("r/oen")
    with pytest.raises(ValueError, match=r"r/director: reload\(\) needs names of components"):
        plugins.reload()
    plugins.unload("r/*")
    plugins.restart("r")
    assert plugins._take() == [("unload", ("r/*",)), ("restart", ("r",))]


def test_an_iteration_with_too_many_requests_is_refused() -> None:
    plugins = PluginControl("r/director", ["r/director", "r/one"])
    for _ in range(64):
        plugins.restart("r/one")
    with pytest.raises(
        ValueError, match="r/director: more than 64 requests in one iteration; name several components in one"
    ):
        plugins.restart("r/one")
    assert len(plugins._take()) == 64


def test_a_system_in_memory_has_no_processes_to_control() -> None:
    with pytest.raises(ValueError, match="r/director declares PluginControl, which needs processes"):
        MemorySystem({"r/director": Director})

"""The common interface of every component, from the command line."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.harness.components import source
from tests.harness.runs import Launched, PortBlock
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

STAGES = {"r/counter": "think", "r/follower": "act", "r/camera": "sensor_acquire", "r/finder": "sensor_prepare"}


@pytest.fixture
def run(tmp_path: Path, ports: PortBlock, launch: Callable[..., Launched]) -> Steered:
    write_system(tmp_path, ports)
    step = 'step: float = 1.0\n    """Added in each iteration."""\n'
    parts = source("small.py").replace(step, f'{step}    size: int = Field(5, frozen=True)\n    """Fixed."""\n')
    (tmp_path / "small.py").write_text(parts.replace("import numpy", "from pydantic import Field\nimport numpy"))
    return Steered(launch("small.yaml"), ports)


def test_state_period_stages_time_awake_and_parameters(run: Steered) -> None:
    for name, stage in STAGES.items():
        run.launched.until_true(lambda name=name: run.component(name)["awake_s"] > 0, f"a report of {name}")  # type: ignore[misc]
        (told,) = run.json("status", name)["components"]
        assert (told["state"], told["period_s"], told["stages"]) == ("running", 0.05, [stage])
        assert told["awake_s"] > 0
        assert {"log_level"} <= {each["setting"] for each in told["parameters"]}
        assert all(each["type"] and isinstance(each["editable"], bool) for each in told["parameters"])
    (counter,) = run.json("status", "r/counter")["components"]
    assert {each["setting"]: each["editable"] for each in counter["parameters"]} == {
        "step": True,
        "size": False,
        "hang": True,
        "log_level": True,
    }
    assert "(int, default, fixed)" in run.fwk("status", "r/counter")


def test_set_refuses_fixed_settings_and_reload_reads_files(run: Steered, tmp_path: Path) -> None:
    assert "r/counter.step = 3.0 since tick" in run.fwk("config", "set", "r/counter.step=3")
    assert "'size' cannot change during a run" in run.fwk("config", "set", "r/counter.size=6", code=2)
    file = tmp_path / "small.yaml"
    file.write_text(file.read_text() + 'config: {r/counter: {step: 7, size: 8}, "*": {log_level: warning}}\n')
    said = run.fwk("config", "reload")
    assert "r/counter.size=8: from the next run on" in said
    assert "r/counter.step = 7.0 since tick" in said
    assert all(f'{name}.log_level = "warning" since tick' in said for name in STAGES)
    assert run.json("config", "get", "r/counter.size")[0]["value"] == 5


def test_each_component_can_be_killed_and_loaded_again(run: Steered) -> None:
    for name in STAGES:
        assert f"{name} stopped" in run.fwk("kill", name)
        assert run.component(name)["state"] == "stopped"
    run.fwk("load", *STAGES)
    run.ticks_pass()
    assert {run.component(name)["state"] for name in STAGES} == {"running"}
    run.end()

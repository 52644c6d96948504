"""With --watch a saved file reloads exactly the components that consist of it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.harness.components import source, sources
from tests.harness.runs import Launched, PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

PARTS = source("small.py")
HELPER = source("helper.py")
LAUNCH = """
name: small
public_url: {url}
hosts: {{both: [r/camera, r/finder]}}
components:
  r/counter: {{use: "small:Counter"}}
  r/helped: {{use: "counting:Counter", channels: {{imu: r/helped_imu}}}}
  r/camera: {{use: "looking:Camera"}}
  r/finder: {{use: "small:Finder"}}
"""


@pytest.fixture
def run(tmp_path: Path, ports: PortBlock, launch: Callable[..., Launched]) -> Steered:
    files = {**sources("small.py", "counting.py", "helper.py"), "looking.py": PARTS}
    write_files(tmp_path, {**files, "small.yaml": LAUNCH.format(url=ports.public_url)})
    return Steered(launch("small.yaml", "--watch"), ports)


def starts(run: Steered) -> dict[str, int]:
    return {each["name"].removeprefix("r/"): each["starts"] for each in run.ask("status")["components"]}


def test_a_changed_file_reloads_its_importers_only(run: Steered, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("ADDED = -1000.0\n")
    run.launched.until("helper.py changed; reloading r/helped")
    run.launched.until("r/helped runs again")
    run.ticks_pass()
    assert run.json("bb", "show", "r/helped_imu")["value"]["heading_rad"] <= -1000.0
    assert starts(run) == {"counter": 1, "helped": 2, "camera": 1, "finder": 1}
    (tmp_path / "looking.py").write_text(PARTS + "\n# changed\n")
    run.launched.until("looking.py changed; reloading r/camera, r/finder")
    run.launched.until("both runs again")
    run.ticks_pass()
    assert starts(run) == {"counter": 1, "helped": 2, "camera": 2, "finder": 2}
    run.end()
    assert run.launched.gone_within(5.0)


def test_a_syntax_error_keeps_the_old_code_running(run: Steered, tmp_path: Path) -> None:
    assert "noted, tick" in run.fwk("note", "here", "it", "begins")
    run.launched.until("here it begins")
    (tmp_path / "helper.py").write_text("ADDED = \n")
    run.launched.until("helper.py:1: invalid syntax; not reloaded, so the old code continues: r/helped")
    run.ticks_pass()
    assert starts(run)["helped"] == 1
    assert "helper.py:1: invalid syntax" in run.fwk("reload", "r/helped", code=2)
    run.steer("stop", "r/counter")
    (tmp_path / "small.py").write_text(PARTS + "\n# changed\n")
    (tmp_path / "helper.py").write_text("ADDED = -1000.0\n")
    run.launched.until("r/helped runs again")
    run.ticks_pass()
    assert run.json("bb", "show", "r/helped_imu")["value"]["heading_rad"] <= -1000.0
    assert run.component("r/counter")["state"] == "stopped"
    run.end()


def test_a_briefly_missing_file_stops_no_component(run: Steered, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("ADDED = \n")
    run.launched.until("helper.py:1: invalid syntax; not reloaded, so the old code continues: r/helped")
    (tmp_path / "helper.py").unlink()
    run.launched.until("helper.py: cannot be read: No such file or directory; not reloaded, so the old code continues")
    run.ticks_pass()
    assert starts(run)["helped"] == 1
    (tmp_path / "new.py").write_text("ADDED = -1000.0\n")
    (tmp_path / "new.py").rename(tmp_path / "helper.py")
    run.launched.until("r/helped runs again")
    run.ticks_pass()
    assert run.json("bb", "show", "r/helped_imu")["value"]["heading_rad"] <= -1000.0
    run.end()


def test_a_failed_component_restarts_when_its_file_is_repaired(run: Steered, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("1 / 0\n")
    run.launched.until("helper.py changed; reloading r/helped")
    run.launched.until_true(lambda: run.component("r/helped")["state"] == "failed", "r/helped fails")
    (tmp_path / "helper.py").write_text(HELPER)
    run.launched.until_true(lambda: run.component("r/helped")["state"] == "running", "r/helped runs")
    run.end()

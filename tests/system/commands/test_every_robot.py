"""One component carries out the commands to all robots."""

from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from fwk.recording.compare import Comparison
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files

pytestmark = pytest.mark.system

FILES = {
    **sources("lcmtypes/crane.lcm", "cranes.py"),
    "it.yaml": """
name: cranes
public_url: {url}
components:
  w/crane: {{use: "cranes:Crane"}}
  one/robot: {{use: "cranes:Robot"}}
  two/robot: {{use: "cranes:Robot"}}
""",
}


def test_every_robot_gets_its_answers_in_any_layout(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, FILES | {"it.yaml": FILES["it.yaml"].format(url=ports.public_url)})
    for name, hosting in (("it.lcm", "process"), ("single.lcm", "single")):
        run = launch("it.yaml", "--ticks", "40", "--speed", "max", "--record", name, "--hosting", hosting)
        assert run.wait() == 0, run.text
    use_types_of(tmp_path)
    for robot in ("one", "two"):
        last = Recording(tmp_path / "it.lcm").decoded(f"{robot}/tally")[-1]
        assert (last.done, last.failed) == (19, 0)  # accepted in one tick, done in the next
    assert Comparison(tmp_path / "it.lcm", tmp_path / "single.lcm", False).difference is None
    replayed(tmp_path, log="it.lcm")

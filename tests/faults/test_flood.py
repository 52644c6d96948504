"""A component floods log, bus and commands: it is throttled, and all other components get their messages."""

import signal
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from tests.faults.aftermath import Aftermath
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock, write_files
from tests.programs.command_system import command_system

pytestmark = pytest.mark.system

AT_ONCE = 300
LAUNCH = """
name: flood
include: [lift.yaml]
components:
  x/flooder: {use: "flood_parts:Flooder"}
  x/listener: {use: "flood_parts:Listener"}
"""


def test_a_flooding_component_delays_no_other(
    launch: Launch, tmp_path: Path, ports: PortBlock, after: Aftermath
) -> None:
    files = command_system(ports.public_url)
    write_files(tmp_path, {**files, **sources("flood_parts.py"), "launch/flood.yaml": LAUNCH})
    (tmp_path / "traces").mkdir()
    use_types_of(tmp_path)
    run = launch("launch/flood.yaml", "--record", "log.lcm")
    run.until_ticks("one/worker", 40)
    after.note(run)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert "lost 0" in run.text
    ticks = len(recording.messages["x/heard"])
    assert recording.decoded("x/heard")[-1].heading_rad == AT_ONCE * ticks
    assert run.text.count("much too much") < AT_ONCE * ticks / 2  # the log is cut at the place of the writer
    assert "lines dropped" in run.text
    tally = recording.decoded("one/tally")[-1]
    assert tally.done > 0
    assert recording.messages["r/lift@x/flooder"]

"""A component floods log, bus and commands at once: it is held back, and everybody else gets all that is theirs."""

import signal
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from tests.faults.aftermath import Aftermath
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock, write_files
from tests.programs.command_system import command_system

pytestmark = pytest.mark.system

AT_ONCE = 300
PARTS = f"""
from fwk import Component, Logger, Reads, Sends, VisionMaster, Writes, channel
import numpy as np
from lcmtypes.lift import lift_t
from lcmtypes.robot import imu_t


class Flooder(Component):
    stage = "think"
    log: Logger
    image: VisionMaster
    imu: Writes[imu_t]
    lift: Sends[lift_t] = channel("r/lift")

    def loop(self) -> None:
        self.image.publish(np.zeros((4, 4), np.uint8))
        for number in range({AT_ONCE}):
            self.log.info("much too much " + str(number))
            self.imu.value.heading_rad += 1.0
            self.imu.write()
            self.lift.send()


class Listener(Component):
    stage = "act"
    imu: Reads[imu_t] = channel("x/imu")
    heard: Writes[imu_t]

    def loop(self) -> None:
        self.heard.value.heading_rad += len(self.imu.fresh)
        self.heard.write()
"""
LAUNCH = """
name: flood
include: [lift.yaml]
components:
  x/flooder: {use: "flood_parts:Flooder"}
  x/listener: {use: "flood_parts:Listener"}
"""


def test_a_flood_of_everything_is_held_back_and_nobody_else_suffers(
    launch: Launch, tmp_path: Path, ports: PortBlock, after: Aftermath
) -> None:
    files = command_system(ports.public_url)
    write_files(tmp_path, {**files, "flood_parts.py": PARTS, "launch/flood.yaml": LAUNCH})
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
    assert run.text.count("much too much") < AT_ONCE * ticks / 2  # the log is cut off where it is written
    assert "lines dropped" in run.text
    tally = recording.decoded("one/tally")[-1]
    assert tally.done > 0
    assert recording.messages["r/lift@x/flooder"]

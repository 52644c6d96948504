"""What components write in `init` is a message like all others: seen, stamped, recorded and replayed."""

from pathlib import Path

import pytest

from fwk.recording.compare import Comparison
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files

pytestmark = pytest.mark.system

PARTS = '''
"""Says in the beginning what there is; dies once."""

from pathlib import Path

from fwk import Clock, Component, Reads, Writes
from lcmtypes.soccer import pose_t


class Speaker(Component):
    stage = "think"
    clock: Clock
    pose: Writes[pose_t]

    def init(self) -> None:
        for self.pose.value.x_m in (1.0, 2.0):
            self.pose.write()
        self.pose.value.x_m = 3.0

    def loop(self) -> None:
        if self.clock.tick == 8 and not Path("died").exists():
            Path("died").touch()
            raise RuntimeError("enough")
        if self.clock.tick % 5 == 1:
            self.pose.write()


class Listener(Component):
    stage = "act"
    pose: Reads[pose_t]
    heard: Writes[pose_t]

    def init(self) -> None:
        self.heard.value.y_m = -1.0
        self.heard.write()

    def loop(self) -> None:
        for pose in self.pose.fresh:
            self.heard.value = pose
            self.heard.write()
'''
LAUNCH = """
name: early
public_url: {url}
components:
  r/speaker: {{use: "parts:Speaker", restart: {{backoff_s: 0.01}}}}
  r/listener: {{use: "parts:Listener"}}
"""


def test_they_go_out_with_the_first_iteration(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, {"parts.py": PARTS, "it.yaml": LAUNCH.format(url=ports.public_url)})
    run = launch("it.yaml", "--ticks", "20", "--speed", "max", "--record", "it.lcm")
    run.wait()
    recording = Recording(tmp_path / "it.lcm")
    said = [(header.tick, header.stage, header.sequence, header.writer) for header in recording.headers("r/pose")]
    first, again = "r/speaker", "r/speaker#2"
    assert said == [
        *((1, 5, sequence, first) for sequence in (1, 2, 3)),
        (6, 5, 4, first),
        *((8, 5, sequence, again) for sequence in (5, 6)),
        *((tick, 5, sequence, again) for tick, sequence in ((11, 7), (16, 8))),
    ]
    assert [header.tick for header in recording.headers("r/heard")] == [1, 1, 1, 1, 6, 8, 8, 11, 16]
    replayed(tmp_path, log="it.lcm")
    launch("it.yaml", "--ticks", "6", "--speed", "max", "--record", "six.lcm").wait()
    launch("it.yaml", "--ticks", "6", "--speed", "max", "--record", "single.lcm", "--hosting", "single").wait()
    assert Comparison(tmp_path / "six.lcm", tmp_path / "single.lcm", False).difference is None

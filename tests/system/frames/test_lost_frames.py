"""Replay of readers that in real time come too late for a frame: the same frames are lost again."""

import os
import signal
from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: watch
public_url: {url}
clock: wall
period_s: 0.02
stage_time_s: 0.01
components:
  r/camera: {{use: "watch:Camera"}}
  a/watcher: {{use: "watch:Watcher"}}
  b/watcher: {{use: "watch:Watcher", config: {{slow: true}}}}
  c/watcher: {{use: "watch:Watcher", config: {{slow: true}}}}
  d/watcher: {{use: "watch:Watcher", config: {{looks_first: true}}}}
hosts: {hosts}
"""


@pytest.fixture(params=["{}", "{pair: [b/watcher, c/watcher]}"], ids=["each alone", "two in a process"])
def watch(request: pytest.FixtureRequest, tmp_path: Path, ports: PortBlock) -> Path:
    launch = LAUNCH.format(url=ports.public_url, hosts=request.param)
    write_files(tmp_path, {**sources("watch.py"), "watch.yaml": launch})
    return tmp_path


def lost(folder: Path, watcher: str) -> int:
    """Returns how many iterations of a watcher found their frame overwritten."""
    return [pose.y_m for pose in Recording(folder / "log.lcm").decoded(f"{watcher}/pose")].count(-1.0)


def test_frames_lost_by_a_slow_reader_are_lost_in_replay(launch: Launch, watch: Path, ports: PortBlock) -> None:
    run = Steered(launch("watch.yaml", "--record", "log.lcm"), ports)
    for start in (2, 3):
        run.launched.until_true(lambda: run.component("b/watcher")["lost"] > 2, "frames lost")
        os.kill(int((watch / "b-watcher.pid").read_text()), signal.SIGKILL)
        run.launched.until(f"runs again, incarnation {start}")
        run.ticks_pass(60)  # the figures are those of the new incarnation
    run.launched.until_true(lambda: run.component("b/watcher")["lost"] > 2, "frames lost again")
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    assert lost(watch, "b") > 6
    replayed(watch)
    replayed(watch, "--only", "b/watcher")

"""Frames in real runs: whole under load, losses noticed in real time, no shared memory left after any kill."""

import os
import signal
from pathlib import Path

import psutil
import pytest

from tests.harness.components import source, sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: frames
public_url: {url}
components:
  r/camera: {{use: "checked_frames:Camera"}}
  a/finder: {{use: "checked_frames:Finder"}}
  b/finder: {{use: "checked_frames:Finder"}}
  c/finder: {{use: "checked_frames:Finder"}}
"""


@pytest.fixture
def frames(tmp_path: Path, ports: PortBlock) -> Path:
    write_files(tmp_path, {**sources("checked_frames.py"), "frames.yaml": LAUNCH.format(url=ports.public_url)})
    return tmp_path


def wall(frames: Path, period_s: float) -> None:
    """A run in real time; a stage may take long, so that no host is late by accident."""
    with (frames / "frames.yaml").open("a") as file:
        file.write(f"clock: wall\nperiod_s: {period_s}\nstage_time_s: 0.2\n")


def seen(log: Path, finder: str) -> list[tuple[int, int]]:
    """Returns the numbers of the frames that a finder saw, and 1 for whole, 0 for torn, -1 for lost."""
    return [(int(pose.x_m), int(pose.y_m)) for pose in Recording(log).decoded(f"{finder}/pose")]


def holders(ring: str) -> list[int]:
    """Returns the processes that have the shared memory of a ring open or mapped."""
    found = []
    for process in psutil.process_iter():
        try:
            names = [os.readlink(each) for each in Path(f"/proc/{process.pid}/fd").iterdir()]
            names += Path(f"/proc/{process.pid}/maps").read_text().splitlines()
            if any(f"memfd:{ring}" in name for name in names):
                found.append(process.pid)
        except OSError:
            continue
    return found


def test_readers_in_lockstep_see_a_whole_frame_each_tick(launch: Launch, frames: Path) -> None:
    run = launch("frames.yaml", "--ticks", "60", "--speed", "max", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    newest = [sum(1 + tick % 3 for tick in range(1, last + 1)) for last in range(1, 61)]
    for finder in "abc":
        assert seen(frames / "log.lcm", finder) == [(number, 1) for number in newest]


def test_an_overwritten_frame_in_real_time_is_counted_and_logged(
    launch: Launch, frames: Path, ports: PortBlock
) -> None:
    wall(frames, 0.05)
    run = Steered(launch("frames.yaml", "--set", "b/finder.dawdle_tick=5", "--record", "log.lcm"), ports)
    run.launched.until("was overwritten before it was read (1 lost so far)")
    run.launched.until("b/finder is on time again")
    run.ticks_pass(5)
    run.launched.until_true(lambda: run.component("b/finder")["lost"] == 1, "a lost frame in the status")
    assert run.component("a/finder")["lost"] == 0
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    log = frames / "log.lcm"
    assert [state for _, state in seen(log, "b")].count(-1) == 1
    assert {state for finder in "abc" for _, state in seen(log, finder)} == {1, -1}
    assert seen(log, "b")[-1][1] == 1  # it continues with the next frame


def test_killed_readers_and_cameras_return_to_whole_frames(launch: Launch, frames: Path, ports: PortBlock) -> None:
    run = Steered(launch("frames.yaml", "--record", "log.lcm"), ports)
    for name, starts in (("a/finder", 2), ("r/camera", 2), ("b/finder", 2), ("r/camera", 3)):
        os.kill(run.component(name)["pid"], signal.SIGKILL)
        run.launched.until(f"{name} runs again, incarnation {starts}")
        run.ticks_pass()
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    for finder in "abc":
        assert {state for _, state in seen(frames / "log.lcm", finder)} == {1}


def test_no_shared_memory_is_left_when_all_is_killed(launch: Launch, frames: Path, ports: PortBlock) -> None:
    own = (frames / "frames.yaml").read_text().replace("r/camera:", f"ring{ports.bus}/camera:")
    (frames / "frames.yaml").write_text(own)
    (frames / "checked_frames.py").write_text(source("checked_frames.py").replace("r/image", f"ring{ports.bus}/image"))
    before = set(os.listdir("/dev/shm"))
    run = Steered(launch("frames.yaml"), ports)
    run.ticks_pass()
    ring = f"ring{ports.bus}/image"
    assert len(holders(ring)) >= 5  # supervisor, zygote, hosts
    run.launched.end()
    assert run.launched.gone_within(10.0)
    assert holders(ring) == []
    assert not {name for name in set(os.listdir("/dev/shm")) - before if "ring" in name or "image" in name}

"""Deleted files of a running system are named, and the run ends with an error."""

import shutil
from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: counted
period_s: 0.05
public_url: {url}
components:
  a/counter: {{use: "idle:Idle"}}
"""


@pytest.fixture
def folder(tmp_path: Path, ports: PortBlock) -> Path:
    write_files(tmp_path, {**sources("idle.py"), "counted.yaml": LAUNCH.format(url=ports.public_url)})
    return tmp_path


def test_a_deleted_run_directory_fails_the_run(launch: Launch, folder: Path) -> None:
    run = launch("counted.yaml", "--ticks", "160")
    run.until("tick ")
    run_dir = run.run_dir
    shutil.rmtree(run_dir.rename(folder / "deleted"))  # at once: the recording in it must not be missed before it
    assert run.wait() == 1
    last = run.text.splitlines()[-8:]
    assert f"counted: broken: the run directory {run_dir} was deleted during the run" in last, run.text
    assert f"the run directory {run_dir} was deleted during the run; files written there are lost" in run.text
    assert not any(line.startswith(("recording: ", "run directory: ")) for line in last)
    assert not run_dir.exists()


def test_a_deleted_recording_fails_the_run(launch: Launch, folder: Path) -> None:
    run = launch("counted.yaml", "--ticks", "160", "--record", "log.lcm")
    run.until("tick ")
    (folder / "log.lcm").write_bytes(b"")
    run.until("another program has cut ")
    (folder / "log.lcm").unlink()
    assert run.wait() == 1
    assert f"the recording {folder / 'log.lcm'} was deleted during the run" in run.text
    assert "\nrecording: " not in run.text
    assert f"run directory: {run.run_dir}" in run.text

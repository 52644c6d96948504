"""Components start in the order of their needs, or later, or not at all; waiting components are named."""

import os
import re
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from fwk.model.tick_events import HostStarted
from tests.harness.components import sources
from tests.harness.logs import Recording
from tests.harness.runs import TIMEOUT_S, Launched, PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: small
public_url: {url}
components:
  r/finder: {{use: "small:Finder"}}
  r/counter: {{use: "small:Counter"}}
  r/follower: {{use: "small:Follower", start: false, needs: counter}}
  r/camera: {{use: "slow_camera:SlowCamera", ready_timeout_s: {timeout}, restart: {{when: {when}}}}}
"""
Start = Callable[..., Launched]


@pytest.fixture
def start(tmp_path: Path, ports: PortBlock, launch: Callable[..., Launched]) -> Start:
    def started(*arguments: str, timeout: float = 60, when: str = "always") -> Launched:
        text = LAUNCH.format(url=ports.public_url, timeout=timeout, when=when)
        write_files(tmp_path, {**sources("small.py", "slow_camera.py"), "small.yaml": text})
        return launch("small.yaml", *arguments)

    return started


@pytest.fixture
def run(start: Start, ports: PortBlock, tmp_path: Path) -> Steered:
    (tmp_path / "go").touch()
    return Steered(start(), ports)


def test_a_user_starts_when_its_vision_master_is_ready(start: Start, ports: PortBlock, tmp_path: Path) -> None:
    launched = start("--ticks", "5", "--record", "log.lcm")

    def states() -> dict[str, tuple[str, str]]:
        try:
            with Client(supervisor_address(ports.bus), TIMEOUT_S) as client:
                return {each["name"]: (each["state"], each["reason"]) for each in client.ask("status")["components"]}
        except ControlError:  # it does not listen yet
            return {}

    launched.until_true(lambda: states().get("r/counter") == ("running", ""), "the counter runs")
    launched.until("r/finder waits for r/camera")
    assert states()["r/finder"] == ("loaded", "waits for r/camera")
    assert states()["r/camera"] == ("init", "")
    assert states()["r/follower"] == ("stopped", "does not start with the run; 'fwk load' starts it")
    (tmp_path / "go").touch()
    assert launched.wait() == 0, launched.text
    recording = Recording(tmp_path / "log.lcm")
    started = [each.host for tick, each in recording.events if tick == 1 and isinstance(each, HostStarted)]
    assert started.index(3) < started.index(0)
    assert set(started) == {0, 1, 3}


def test_a_missed_ready_timeout_names_component_and_dependents(start: Start) -> None:
    launched = start("--ticks", "5", timeout=3)
    assert launched.wait() == 1
    assert "r/camera: not ready after 3 s; still in init: r/camera\nr/finder: waits for r/camera" in launched.text


def test_a_missed_ready_timeout_after_a_restart_is_named(start: Start, ports: PortBlock, tmp_path: Path) -> None:
    (tmp_path / "go").touch()
    run = Steered(start(timeout=3, when="never"), ports)
    (tmp_path / "go").unlink()
    said = run.fwk("restart", "r/camera", code=1)
    assert re.search(r"r/camera failed, tick \d+: not ready after 3 s; still in init: r/camera\n", said)
    run.launched.until("r/camera ended: not ready after 3 s; still in init: r/camera")


def test_a_component_outside_the_launch_file_is_not_loaded(run: Steered) -> None:
    said = run.fwk("load", "r/folower", code=2)
    assert "no component 'r/folower'; did you mean 'r/follower'?; only components of the launch file" in said


def test_a_component_that_is_loaded_later_replays(run: Steered, tmp_path: Path) -> None:
    assert run.component("r/follower")["starts"] == 0
    assert "r/follower running" in run.fwk("load", "r/follower")
    run.ticks_pass()
    log = run.end()
    recording = Recording(log)
    poses = recording.decoded("r/pose")
    counts = {header.tick: header.tick for header in recording.headers("r/imu")}
    assert poses
    assert all(pose.heading_rad == counts[pose.header.tick] for pose in poses)
    assert poses[0].header.sequence == 1
    assert not recording.gaps()
    run.fwk("replay", str(log), "--verify")


def test_a_restart_waits_for_its_vision_master(run: Steered, tmp_path: Path) -> None:
    (tmp_path / "go").unlink()
    os.kill(run.component("r/camera")["pid"], signal.SIGKILL)
    os.kill(run.component("r/finder")["pid"], signal.SIGKILL)
    run.launched.until("r/finder waits for r/camera")
    (tmp_path / "go").touch()
    run.launched.until("r/finder runs again")
    run.ticks_pass()
    recording = Recording(run.end())
    last = recording.records[-1].tick - 1
    assert [header.tick for header in recording.headers("r/seen")][:last] == list(range(1, last + 1))


def test_a_crash_without_its_vision_master_fails_with_a_reason(run: Steered) -> None:
    assert "r/image keeps its last value for r/finder" in run.fwk("stop", "r/camera")
    os.kill(run.component("r/finder")["pid"], signal.SIGKILL)
    run.launched.until("r/finder: not started: it needs r/camera, which is stopped")
    run.ticks_pass()
    finder = run.component("r/finder")
    assert (finder["state"], finder["reason"]) == ("failed", "needs r/camera, which is stopped")
    run.fwk("load", "r/finder")
    run.ticks_pass()
    assert {run.component(name)["state"] for name in ("r/camera", "r/finder")} == {"running"}
    run.end()


def test_a_component_stopped_by_kill_does_not_return(run: Steered) -> None:
    assert "r/counter stopped" in run.fwk("kill", "r/counter")
    run.ticks_pass()
    assert (run.component("r/counter")["state"], run.component("r/counter")["pid"]) == ("stopped", 0)
    assert "counted enough" not in run.fwk("log", "--component", "r/counter")
    run.fwk("start", "r/counter")
    run.ticks_pass()
    assert not Recording(run.end()).gaps()

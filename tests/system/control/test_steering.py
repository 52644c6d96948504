"""Components are stopped, started, restarted and reloaded in a real run, from another terminal."""

import os
import signal
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from fwk.control.client import ControlError
from fwk.model.tick_events import HostLost, HostStarted, HostStopped
from tests.harness.components import source
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

PARTS = source("small.py")


@pytest.fixture
def run(tmp_path: Path, ports: PortBlock, launch: Callable[..., object]) -> Steered:
    write_system(tmp_path, ports)
    return Steered(launch("small.yaml"), ports)  # type: ignore[arg-type]


def events(recording: Recording, kind: type[HostLost | HostStarted | HostStopped], host: int) -> list[int]:
    """Returns the ticks of these events of a host."""
    return [tick for tick, each in recording.events if isinstance(each, kind) and each.host == host]


def test_a_stopped_writer_leaves_its_last_value_until_started(run: Steered) -> None:
    pid = run.component("r/counter")["pid"]
    assert "r/counter stopped" in run.fwk("stop", "r/counter")
    assert not psutil.pid_exists(pid)
    assert "counted enough" in run.fwk("log", "--component", "r/counter")
    assert run.component("r/counter")["state"] == "stopped"
    run.ticks_pass()
    assert "r/follower running" in run.fwk("restart", "r/follower")  # a newcomer, which must see the last value too
    run.ticks_pass()
    before = run.json("bb", "show", "r/imu")["value"]["heading_rad"]
    assert run.json("bb", "show", "r/pose")["value"]["heading_rad"] == before > 0
    assert "r/counter running" in run.fwk("start", "r/counter")
    run.ticks_pass()
    recording = Recording(run.end())
    assert not recording.gaps()
    headers = recording.headers("r/imu")
    (stopped,), (_, started) = events(recording, HostStopped, 0), events(recording, HostStarted, 0)
    ticks = [header.tick for header in headers]
    expected = [*range(1, stopped), *range(started, recording.records[-1].tick)]
    assert ticks[: len(expected)] == expected
    assert {header.writer for header in headers if header.tick >= started} == {"r/counter#2"}
    assert not events(recording, HostLost, 0)
    frozen = [pose.heading_rad for pose in recording.decoded("r/pose") if stopped <= pose.header.tick < started]
    assert set(frozen) == {float(stopped - 1)}


@pytest.mark.core
def test_a_restart_in_lockstep_misses_no_tick(run: Steered) -> None:
    for _ in range(2):
        run.steer("restart", "r/counter", "r/finder")
    assert run.component("r/counter")["starts"] == 3
    recording = Recording(run.end())
    assert not recording.gaps()
    last = recording.records[-1].tick - 1  # the end may come in the middle of a tick
    for channel in ("r/imu", "r/seen"):
        assert [header.tick for header in recording.headers(channel)][:last] == list(range(1, last + 1))
    assert len(events(recording, HostStopped, 0)) == 2
    assert len(events(recording, HostStarted, 0)) == 3


def test_reload_changes_the_code_of_one_component_only(run: Steered) -> None:
    file = run.launched.folder / "small.py"
    pids = {each["name"]: each["pid"] for each in run.ask("status")["components"]}
    file.write_text(PARTS.replace("def loop(self) -> None:\n        while", "def loop(self) -> None\n        while"))
    assert "small.py:" in run.fwk("reload", "r/counter", code=2)
    assert run.component("r/counter")["pid"] == pids["r/counter"]
    file.write_text(PARTS.replace("+= self.config.step", "-= 1000.0").replace("x_m = 1.0", "x_m = 2.0"))
    run.fwk("reload", "r/counter")
    run.ticks_pass()
    assert run.json("bb", "show", "r/imu")["value"]["heading_rad"] <= -1000.0
    assert run.json("bb", "show", "r/pose")["value"]["x_m"] == 1.0
    run.steer("restart", "r/follower")
    run.ticks_pass()
    assert run.json("bb", "show", "r/pose")["value"]["x_m"] == 1.0  # restarted, not reloaded
    now = {each["name"]: each["pid"] for each in run.ask("status")["components"]}
    assert [name for name in now if now[name] == pids[name]] == ["r/camera", "r/finder"]
    run.end()


def test_reloaded_code_that_fails_is_reported_and_repaired(run: Steered) -> None:
    file = run.launched.folder / "small.py"
    file.write_text(PARTS.replace('"""Counts its iterations."""', "1 / 0"))
    said = run.fwk("reload", "r/counter", code=1)
    assert "r/counter failed" in said
    assert "ZeroDivisionError" in said
    run.ticks_pass()
    file.write_text(PARTS)
    run.steer("reload", "r/counter")
    assert run.component("r/counter")["state"] == "running"
    run.end()


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (
            'stage = "think"',
            'stage = ("think", "skill")',
            "the stage of its class was think when the run began and is now think, skill; start the run again",
        ),
        (
            "imu: Writes[imu_t]",
            "imu: Reads[imu_t]",
            "'imu' of its class was writes robot.imu_t of imu when the run began and is now reads robot.imu_t of imu; ",
        ),
        (
            "    step: float = 1.0",
            "    steps: float = 1.0",
            "do not fit its class: 'step': Extra inputs are not permitted",
        ),
    ],
)
def test_code_that_needs_another_plan_is_refused(run: Steered, old: str, new: str, text: str) -> None:
    file = run.launched.folder / "small.py"
    assert old in PARTS
    file.write_text(PARTS.replace(old, new))
    assert text in run.fwk("reload", "r/counter", code=1)
    own = PARTS.replace("import Component,", "import Clock, Component,").replace(
        "config: C", "time: Clock\n    config: C"
    )
    file.write_text(own)  # an aspect that the component needs for itself requires no other plan
    run.steer("reload", "r/counter")
    assert run.component("r/counter")["state"] == "running"
    run.end()


def test_a_vision_master_stays_while_it_has_users(run: Steered) -> None:
    assert "r/camera is needed by r/finder" in run.fwk("unload", "r/camera", code=2)
    run.fwk("unload", "r/camera", "r/finder")
    assert "r/finder needs r/camera, which does not run" in run.fwk("start", "r/finder", code=2)
    run.fwk("load", "r/finder")
    assert {run.component(name)["state"] for name in ("r/camera", "r/finder")} == {"running"}
    assert "did you mean 'r/camera'?" in run.fwk("stop", "r/camra", code=2)
    stopped = run.fwk("stop", "--force", "r/camera")
    assert "r/camera stopped" in stopped
    assert "r/finder stopped" in stopped
    run.end()


def test_a_hanging_component_is_named_and_can_be_stopped(run: Steered) -> None:
    with pytest.raises(ControlError, match=r"not answered within 0\.5 s"):
        run.ask("set", timeout_s=0.5, changes=["r/counter.hang=true"])
    run.launched.until_true(lambda: run.ask("status")["waits_for"] == ["r/counter"], "somebody it waits for")
    assert "waits for r/counter" in run.fwk("status")
    with pytest.raises(ControlError, match=r"within 0\.5 s; its loop waits for r/counter: a component"):
        run.ask("set", timeout_s=0.5, changes=["r/counter.hang=false"])
    tick = run.tick
    assert "r/counter stopped" in run.fwk("stop", "r/counter")
    assert run.component("r/counter")["reason"] == "did not come out of its iteration; killed"
    run.ticks_pass()
    assert run.tick > tick
    run.steer("start", "r/counter")
    run.ticks_pass()
    assert run.component("r/counter")["state"] == "running"
    run.end()


@pytest.mark.parametrize("paused", [True, False])
def test_a_component_that_waits_for_its_restart_can_be_stopped(
    tmp_path: Path, ports: PortBlock, launch: Launch, paused: bool
) -> None:
    """The component ends between two ticks of a run that is paused, otherwise in its iteration."""
    write_system(tmp_path, ports)
    file = tmp_path / "small.yaml"
    file.write_text(file.read_text().replace("{limit: 1}", "{limit: 1, backoff_s: 3600}"))
    run = Steered(launch("small.yaml"), ports)
    counter = run.component("r/counter")["pid"]
    if paused:
        run.fwk("pause")
    else:
        os.kill(counter, signal.SIGSTOP)
        run.launched.until_true(lambda: run.ask("status")["waits_for"] == ["r/counter"], "a tick that waits for it")
    os.kill(counter, signal.SIGKILL)
    run.launched.until_true(lambda: run.component("r/counter")["state"] == "waiting", "its end")
    run.ask("resume")
    run.launched.until_true(lambda: run.ask("status")["waits_for"] == ["r/counter"], "a run that waits for it")
    assert "r/counter stopped" in run.fwk("stop", "r/counter")
    run.ticks_pass()
    run.steer("start", "r/counter")
    run.ticks_pass()
    assert run.component("r/counter")["state"] == "running"
    assert "byte for byte" in run.fwk("replay", str(run.end()), "--verify")

"""Continuous components in real processes: their own rates, no waiting, and exact replay."""

import os
import signal
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from fwk.model.tick_events import HostLost, StageBegun
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, fwk, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: restless
public_url: {url}
period_s: 0.05
components:
  r/counter: {{use: "restless:Counter"}}
  r/planner: {{use: "restless:Planner", restart: {{backoff_s: 0}}}}
  r/follower: {{use: "restless:Follower"}}
"""
PLANNER = 1
RATE_HZ = 40
Start = Callable[..., Steered]


@pytest.fixture
def folder(tmp_path: Path, ports: PortBlock) -> Path:
    write_files(
        tmp_path, {**sources("restless.py", "weather.py"), "restless.yaml": LAUNCH.format(url=ports.public_url)}
    )
    return tmp_path


@pytest.fixture
def start(folder: Path, ports: PortBlock, launch: Launch) -> Start:
    return lambda *arguments, **more: Steered(launch("restless.yaml", *arguments, **more), ports)


def planned(folder: Path) -> int:
    file = folder / "planned"
    return int(file.read_text() or 0) if file.exists() else 0


def until_planned(run: Steered, number: int) -> None:
    before = planned(run.launched.folder)
    run.launched.until_true(lambda: planned(run.launched.folder) >= before + number, f"{number} more plans")


def verified(log: Path) -> Recording:
    replayed(log.parent, log=log)
    recording = Recording(log)
    assert recording.gaps() == {}
    return recording


@pytest.mark.parametrize("loss", ["0", "0.1"])
def test_the_main_loop_goes_on_and_no_message_is_missed(start: Start, loss: str) -> None:
    run = start("--speed", "max", env={"FWK_TEST_LOSS": loss})
    until_planned(run, 20)
    recording = verified(run.end())
    poses = recording.decoded("r/pose")
    assert [pose.header.stage for pose in poses] == [1] * len(poses)
    assert any(after.header.tick > before.header.tick + 1 for before, after in pairwise(poses))
    heard = [(pose.y_m, pose.heading_rad) for pose in poses if pose.heading_rad]
    first_tick = poses[0].header.tick  # a component whose first iteration is later hears only the newest message
    assert heard[0][0] == max(1, first_tick - 1)
    assert all(after[0] == before[1] + 1 for before, after in pairwise(heard))  # each message once, in order
    ticks = {record.tick for record in recording.records}
    assert len(recording.headers("r/imu")) >= len(ticks) - 1  # the counter has run in each tick


def test_a_killed_and_restarted_planner_replays(start: Start, folder: Path) -> None:
    run = start("--speed", "5", "--set", "r/planner.takes_s=0.1")
    until_planned(run, 3)
    pid = int((folder / "planner.pid").read_text())
    os.kill(pid, signal.SIGKILL)
    run.launched.until("r/planner runs again, incarnation 2")
    until_planned(run, 3)
    run.ask("set", changes=["r/planner.gain=3", "r/planner.takes_s=0.01"])
    until_planned(run, 3)
    run.steer("restart", "r/planner", "r/follower")
    until_planned(run, 3)
    run.steer("stop", "r/planner")
    run.ticks_pass()
    run.steer("start", "r/planner")
    until_planned(run, 3)
    recording = verified(run.end())
    writers = list(dict.fromkeys(header.writer for header in recording.headers("r/pose")))
    assert writers == ["r/planner", "r/planner#2", "r/planner#3", "r/planner#4"]
    lost = [event.host for _, event in recording.events if isinstance(event, HostLost)]
    assert lost == [PLANNER]


def test_iterations_per_tick_are_bounded_by_the_rate(start: Start, folder: Path) -> None:
    file = folder / "restless.yaml"
    file.write_text(file.read_text().replace('"restless:Planner",', '"restless:Planner", rate_hz: 100,'))
    run = start("--set", "r/planner.takes_s=0")
    assert run.ask("period", name="r/planner") == {"ok": True, "name": "r/planner", "period_us": 10_000, "stages": []}
    assert "100 Hz" in run.fwk("status")
    assert "100 Hz" in fwk(folder, "check", "restless.yaml", "--channels")
    until_planned(run, 30)
    run.ask("pause")
    run.steer("restart", "r/follower")
    run.ask("resume")
    until_planned(run, 10)
    headers = verified(run.end()).headers("r/pose")
    numbers = {header.stage for header in headers}
    assert max(numbers) in (2, 3, 4, 5)  # 100 Hz in 50 ms
    for before, after in pairwise(headers):
        assert (after.tick, after.stage) > (before.tick, before.stage)


def test_no_iteration_in_real_time_is_ahead_of_the_rate(start: Start, folder: Path) -> None:
    """Iteration number n never begins earlier than n - 1 periods after `init`; a busy machine can only delay it."""
    file = folder / "restless.yaml"
    text = file.read_text().replace('"restless:Planner",', f'"restless:Planner", rate_hz: {RATE_HZ},')
    assert "rate_hz" in text
    file.write_text(text + "clock: wall\nstage_time_s: 0.5\n")
    run = start("--set", "r/planner.takes_s=0.001")
    until_planned(run, 40)
    log = run.end()
    init_us, *begun_us = map(int, (folder / "times").read_text().split())
    assert len(begun_us) >= 40
    earliest_us = [init_us + (number - 1) * round(1e6 / RATE_HZ) for number in range(len(begun_us))]
    ahead = [
        number for number, (at_us, least_us) in enumerate(zip(begun_us, earliest_us, strict=True)) if at_us < least_us
    ]
    assert ahead == []
    verified(log)


def test_a_continuous_component_takes_over_the_main_loop(start: Start) -> None:
    run = start("--speed", "max", "--set", "r/planner.takes_loop=5")
    run.launched.until("r/planner has given the main loop back")
    until_planned(run, 3)
    recording = verified(run.end())
    steps: dict[int, list[int]] = {}
    for tick, event in recording.events:
        if isinstance(event, StageBegun):
            steps.setdefault(tick, []).append(event.step)
    assert [0, 1, 2] in steps.values()

"""Decisions of a boundary may be larger than a datagram: the run goes on, and replays."""

import signal
from pathlib import Path

import pytest

from fwk.recording.compare import compare
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

COMPONENTS = 9
LAUNCH = """
name: greedy
public_url: {url}
speed: max
spare_channels: 5
components:
"""


@pytest.fixture
def greedy(tmp_path: Path, ports: PortBlock) -> Path:
    lines = [f'  r{number}/greedy: {{use: "greedy:Greedy"}}\n' for number in range(COMPONENTS)]
    text = LAUNCH.format(url=ports.public_url) + "".join(lines)
    write_files(tmp_path, {**sources("greedy.py", "weather.py"), "greedy.yaml": text})
    return tmp_path


@pytest.mark.parametrize("loss", ["0", "0.1"])
def test_many_requests_at_once_are_answered_in_any_layout(greedy: Path, launch: Launch, loss: str) -> None:
    for hosting in ("process", "single"):
        arguments = ("--ticks", "4", "--hosting", hosting, "--record", f"{hosting}.log")
        run = launch("greedy.yaml", *arguments, env={"FWK_TEST_LOSS": loss})
        assert run.wait() == 0, run.text
    assert compare(greedy / "process.log", greedy / "single.log") is None
    replayed(greedy, log="single.log")
    answered = [Recording(greedy / "single.log").decoded(f"r{number}/imu")[-1] for number in range(COMPONENTS)]
    assert [imu.heading_rad for imu in answered] == [64.0] * COMPONENTS


def test_large_settings_reach_all_hosts_in_one_tick(greedy: Path, launch: Launch, ports: PortBlock) -> None:
    run = Steered(launch("greedy.yaml", "--record", "log.lcm"), ports)
    run.ticks_pass(3)
    run.ask("pause")
    for gain in (100, 200):
        run.ask("set", changes=[f"*/greedy.gain={gain}"])
    run.ask("resume")
    run.ticks_pass(3)
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    log = Recording(greedy / "log.lcm")
    changed = [
        next(imu.header.tick for imu in log.decoded(f"r{number}/imu") if imu.heading_rad > 200)
        for number in range(COMPONENTS)
    ]
    assert len(set(changed)) == 1
    replayed(greedy)

"""Components are killed repeatedly during a match; acknowledged settings survive."""

import os
import random
import signal
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from fwk.control.client import ControlError
from tests.faults.aftermath import Aftermath
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[2]
MATCH_S = 8
TICKS_BETWEEN = 16


def victims(steered: Steered, luck: random.Random) -> Iterator[int]:
    """Yields processes of components in a random order, each component once before any twice, until the run ends.

    Some ticks pass before each: in lockstep no tick begins until a killed component is back.
    """
    while True:
        names = [each["name"] for each in steered.ask("status")["components"]]
        for name in luck.sample(names, len(names)):
            steered.ticks_pass(TICKS_BETWEEN)
            yield steered.component(name)["pid"]


@pytest.mark.slow
def test_a_match_goes_on_when_components_are_killed(
    launch: Launch, tmp_path: Path, ports: PortBlock, after: Aftermath
) -> None:
    arguments = ("--time", str(MATCH_S), "--speed", "max", "--seed", "7", "--record", "log.lcm")
    url = ("--set", f"public_url={ports.public_url}")
    run = launch(str(ROOT / "launch/soccer-1v1.yaml"), *arguments, *url)
    run.until("tick ")
    after.note(run)
    killed = 0
    try:
        for pid in victims(Steered(run, ports), random.Random(1)):
            if pid and run.process.poll() is None:
                os.kill(pid, signal.SIGKILL)
                killed += 1
    except (ControlError, ProcessLookupError):
        assert run.wait() == 0, run.text
    recording = after.check(run)
    assert killed >= 5
    assert run.text.count("ended: killed by signal 9") >= killed - 1  # the last death may coincide with the end
    assert "lost 0" in run.text
    assert recording.gaps() == {}
    assert recording.records[-1].time_us >= MATCH_S * 1_000_000


@pytest.mark.parametrize("moment", ["after", "before", "while"])
def test_an_acknowledged_setting_survives_a_crash(
    launch: Launch, tmp_path: Path, ports: PortBlock, moment: str
) -> None:
    """The component dies before, while or after it takes the setting over."""
    write_system(tmp_path, ports)
    steered = Steered(launch("small.yaml"), ports)
    counter, run = steered.component("r/counter")["pid"], steered.launched
    if moment == "while":
        os.kill(counter, signal.SIGSTOP)
        run.until_true(lambda: list(steered.ask("status")["waits_for"]) == ["r/counter"], "the loop waits")
    if moment == "before":
        os.kill(counter, signal.SIGKILL)
    with ThreadPoolExecutor() as pool:
        acknowledged = pool.submit(steered.ask, "set", changes=["r/counter.step=7"], origin="a test")
        if moment == "while":
            os.kill(counter, signal.SIGKILL)
        assert acknowledged.result()["settings"]
    if moment == "after":
        os.kill(counter, signal.SIGKILL)
    run.until("r/counter runs again, incarnation 2")
    steered.ticks_pass(5)
    first = steered.json("bb", "show", "r/imu")["value"]
    steered.ticks_pass(3)
    later = steered.json("bb", "show", "r/imu")["value"]
    ticks = later["header"]["tick"] - first["header"]["tick"]
    assert later["heading_rad"] - first["heading_rad"] == 7.0 * ticks
    steered.end()

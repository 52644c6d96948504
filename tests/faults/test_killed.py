"""Components are killed repeatedly during a match; acknowledged settings survive."""

import os
import random
import signal
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import islice
from pathlib import Path

import pytest

from fwk.model.tick_events import HostLost
from tests.faults.aftermath import Aftermath
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[2]
KILLS = 8
TICKS_BETWEEN = 16


def victims(steered: Steered, luck: random.Random) -> Iterator[int]:
    """Yields processes of running components in a random order, each component once before any twice.

    Some ticks pass before each: in lockstep no tick begins until a killed component is back.
    """
    while True:
        names = [each["name"] for each in steered.ask("status")["components"] if each["pid"]]
        for name in luck.sample(names, len(names)):
            steered.ticks_pass(TICKS_BETWEEN)
            yield steered.component(name)["pid"]


@pytest.mark.slow
def test_a_match_goes_on_when_components_are_killed(
    launch: Launch, tmp_path: Path, ports: PortBlock, after: Aftermath
) -> None:
    url = ("--set", f"public_url={ports.public_url}")
    run = launch(str(ROOT / "launch/soccer-1v1.yaml"), "--speed", "max", "--seed", "7", "--record", "log.lcm", *url)
    run.until("tick ")
    after.note(run)
    steered = Steered(run, ports)
    for pid in islice(victims(steered, random.Random(1)), KILLS):
        os.kill(pid, signal.SIGKILL)
    steered.ticks_pass(TICKS_BETWEEN)
    steered.end()
    recording = after.check(run)
    assert "ended: killed by signal 9" in run.text
    assert sum(isinstance(event, HostLost) for _, event in recording.events) == KILLS
    assert "lost 0" in run.text
    assert recording.gaps() == {}
    assert recording.records[-1].tick >= KILLS * TICKS_BETWEEN


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

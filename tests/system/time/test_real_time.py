"""Real time: the loop keeps its pace despite late or dead hosts, and names them."""

import os
import re
import signal
from pathlib import Path

import pytest

from fwk.model.tick_events import HostLate, StageDone
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock

pytestmark = pytest.mark.system

RUN = ("launch/orchestra.yaml", "--record", "log.lcm")


@pytest.fixture
def wall(folder: Path, ports: PortBlock) -> Path:
    """The orchestra in real time, without a conductor; players leave traces."""
    file = folder / "launch/orchestra.yaml"
    lines = [line for line in file.read_text().splitlines() if "conductor" not in line and "speed" not in line]
    file.write_text("\n".join([*lines, "clock: wall", "period_s: 0.05", "stage_time_s: 0.3", ""]))
    (folder / "traces").mkdir()
    return folder


def late_ticks(recording: Recording) -> dict[int, int]:
    """Returns the ticks with a late host, with the tick in which its answer came."""
    found: dict[int, int] = {}
    for tick, event in recording.events:
        if isinstance(event, HostLate):
            found[tick] = 0
        elif isinstance(event, StageDone) and event.tick in found and event.tick != tick:
            found[event.tick] = tick
    return found


@pytest.mark.core
def test_a_late_host_is_counted_and_its_outputs_follow_its_done(launch: Launch, wall: Path) -> None:
    sets = ("--set", "d/player.trouble=loop:wait", "--set", "d/player.trouble_tick=5")
    run = launch(*RUN, *sets)
    run.until_true(lambda: (wall / "trouble-d_player").exists(), "d/player waits")
    run.until("d/player is late: think of tick ")
    late = int(re.findall(r"d/player is late: think of tick (\d+) took longer than 300 ms", run.text)[-1])
    run.until_ticks("f/player", 10)
    (wall / "go-on").touch()
    run.until(f"d/player is on time again; its tick {late} took ")
    run.until_true(lambda: run.tick("d/player") > late, "another tick of d/player")
    run.until_ticks("f/player", 5)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    assert "late 0" not in run.text.rpartition("orchestra: interrupted")[2]
    recording = Recording(wall / "log.lcm")
    assert recording.gaps() == {}
    answered = late_ticks(recording)[late]
    assert answered >= late + 10
    ticks = [header.tick for header in recording.headers("d/note")]
    assert ticks[ticks.index(late) + 1] >= answered  # a missed iteration is not run later
    for note in recording.decoded("f/note"):
        heard = next(heard for heard in note.heard if heard.channel == "d/note")
        if late <= note.header.tick < answered:
            assert heard.newest_tick < late


@pytest.mark.parametrize("loss", ["0", "0.2"])
def test_the_loop_keeps_its_pace_and_late_hosts_return(launch: Launch, wall: Path, loss: str) -> None:
    file = wall / "launch/orchestra.yaml"
    file.write_text(file.read_text().replace("stage_time_s: 0.3", "stage_time_s: 0.05"))
    run = launch(*RUN, "--ticks", "40", env={"FWK_TEST_LOSS": loss})
    assert run.wait() == 0, run.text
    recording = Recording(wall / "log.lcm")
    assert recording.gaps() == {}
    times = [record.time_us for record in recording.records]
    assert len(times) == 40
    assert times == sorted(set(times))
    assert times[-1] >= 39 * 50_000  # never faster than wall time
    for player in "abcdef":
        assert max(header.tick for header in recording.headers(f"{player}/note")) > 20  # late hosts came back


def test_the_loop_does_not_wait_for_a_killed_component(launch: Launch, wall: Path) -> None:
    file = wall / "launch/orchestra.yaml"
    file.write_text(file.read_text().replace("c/player: {", "c/player: { restart: { backoff_s: 0.5 },"))
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    os.kill(run.host("c/player"), signal.SIGKILL)
    run.until("c/player runs again, incarnation 2")
    run.until_ticks("c/player", 3)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    recording = Recording(wall / "log.lcm")
    assert recording.gaps() == {}
    ticks = {player: [header.tick for header in recording.headers(f"{player}/note")] for player in "cf"}
    assert set(ticks["f"]) - set(ticks["c"])  # the other hosts went on


def test_a_host_that_stood_still_takes_part_again(launch: Launch, wall: Path) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 3)
    os.kill(run.host("d/player"), signal.SIGSTOP)
    run.until("d/player is late")
    run.until_ticks("f/player", 5)
    os.kill(run.host("d/player"), signal.SIGCONT)
    run.until("d/player is on time again")
    run.until_ticks("d/player", 3)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    assert Recording(wall / "log.lcm").gaps() == {}

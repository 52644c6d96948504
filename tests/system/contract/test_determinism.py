"""The same launch with the same seed gives the same messages, whatever the layout, the load and the losses."""

import multiprocessing
import subprocess
import zlib
from collections.abc import Callable
from itertools import pairwise
from multiprocessing.synchronize import Event
from pathlib import Path

import pytest

from tests.harness.fixtures import Launch
from tests.harness.in_memory import played_in_memory
from tests.harness.logs import Recording, difference
from tests.harness.runs import fwk, played
from tests.programs.orchestra import GROUPS, PLAYERS, orchestra

pytestmark = pytest.mark.system

TICKS = 25
RUN = ("launch/orchestra.yaml", "--ticks", str(TICKS), "--seed", "7")
RECORD = ("--record", "log.lcm")


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of an undisturbed run with one process for each component."""
    return played(tmp_path_factory.mktemp("reference"), orchestra, *RUN, *RECORD)


@pytest.mark.core
def test_everything_is_in_the_recording(reference: Path) -> None:
    recording = Recording(reference)
    assert recording.gaps() == {}
    assert len(recording.records) == TICKS
    counts = {channel: len(found) for channel, found in recording.messages.items()}
    assert counts.keys() == {f"{player}/{kind}" for player in PLAYERS for kind in ("note", "burst")} | {
        "a/image",
        "a/look",
    }
    assert counts["a/note"] == 2 * TICKS  # two stages
    assert counts["b/note"] == counts["a/look"] == TICKS
    assert 0 < counts["b/burst"] < 3 * TICKS
    steps = {after.time_us - before.time_us for before, after in pairwise(recording.records)}
    assert len(steps) > TICKS // 2  # the conductor's time, not the period


@pytest.mark.parametrize("hosting", ["robot", "single", "groups"])
def test_the_layout_of_processes_changes_no_message(
    launch: Launch, folder: Path, reference: Path, hosting: str
) -> None:
    if hosting == "groups":
        with open(folder / "launch/orchestra.yaml", "a") as file:
            file.write(GROUPS)
        run = launch(*RUN, *RECORD)
    else:
        run = launch(*RUN, *RECORD, "--hosting", hosting)
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""


@pytest.mark.parametrize(
    "weather",
    [
        pytest.param({"FWK_TEST_LOSS": "0.02"}, id="2 percent lost"),
        pytest.param({"FWK_TEST_LOSS": "0.1"}, id="10 percent lost"),
        pytest.param({"FWK_TEST_BUFFER_BYTES": "70000"}, id="small buffers"),
    ],
)
@pytest.mark.core
def test_lost_datagrams_change_nothing(launch: Launch, folder: Path, reference: Path, weather: dict[str, str]) -> None:
    run = launch(*RUN, *RECORD, env=weather)
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""
    assert "lost 0" in run.text
    assert "fetched" in run.text


def test_losses_in_the_kernel_change_nothing(
    launch: Launch, folder: Path, reference: Path, needs: Callable[..., None], leave_out: Callable[[str], None]
) -> None:
    needs("unshare", "ip", "iptables")
    drop = "iptables -A INPUT -i lo -p udp -m statistic --mode random --probability 0.1 -j DROP"
    shell = ("unshare", "-rn", "sh", "-c", f'ip link set lo up && {drop} && exec "$0" "$@"')
    if subprocess.run([*shell, "true"], capture_output=True, check=False).returncode:
        leave_out("needs network namespaces and iptables' statistic match: run as root")
    run = launch(*RUN, *RECORD, wrapper=shell)
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""
    assert "fetched" in run.text


def test_a_busy_machine_changes_nothing(launch: Launch, folder: Path, reference: Path) -> None:
    enough = multiprocessing.Event()
    children = [multiprocessing.Process(target=_keep_busy, args=(enough,)) for _ in range(3)]
    for child in children:
        child.start()
    try:
        run = launch(*RUN, *RECORD)
        assert run.wait() == 0, run.text
    finally:
        enough.set()
        for child in children:
            child.join()
    assert difference(reference, folder / "log.lcm") == ""


def _keep_busy(enough: Event) -> None:
    for _ in range(20_000):  # bounded, whatever happens to the parent
        if enough.is_set():
            return
        zlib.crc32(bytes(1_000_000))


def test_a_system_in_memory_gives_the_same_messages(folder: Path, reference: Path) -> None:
    assert difference(reference, played_in_memory(folder, RUN[0], TICKS, 7)) == ""


def test_another_seed_gives_other_messages(launch: Launch, folder: Path, reference: Path) -> None:
    run = launch(*RUN[:-1], "8", *RECORD)
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") != ""


def test_a_changed_component_is_found_by_compare(launch: Launch, folder: Path, reference: Path) -> None:
    run = launch(*RUN, *RECORD, "--set", "d/player.tone=1")
    assert run.wait() == 0, run.text
    said = fwk(folder, "compare", reference, "log.lcm", code=1)
    assert "different: d/note: tick 1, stage 5, message 1 by d/player: digest is " in said

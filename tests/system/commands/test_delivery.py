"""Commands and requests between real processes: carried out at most once, despite losses and crashes."""

import os
import signal
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.in_memory import played_in_memory
from tests.harness.logs import Recording, difference
from tests.harness.runs import Launched, PortBlock, played, replayed, write_files
from tests.programs.command_system import command_system

pytestmark = pytest.mark.system

TICKS = 60
FILE = "launch/lift.yaml"
RUN = (FILE, "--ticks", str(TICKS), "--seed", "3", "--record", "log.lcm")
WORKERS = ("one", "two")


@pytest.fixture(scope="module", autouse=True)
def _types(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("types")
    write_files(folder, sources("lcmtypes/lift.lcm"))
    use_types_of(folder)


@pytest.fixture
def folder(tmp_path: Path, ports: PortBlock) -> Path:
    """A user's folder with the lifting system."""
    write_files(tmp_path, command_system(ports.public_url))
    (tmp_path / "traces").mkdir()
    return tmp_path


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of an undisturbed run with one process for each component."""
    return played(tmp_path_factory.mktemp("reference"), command_system, *RUN)


def begun(recording: Recording) -> list[tuple[str, int]]:
    """Returns sender and number of the lifts that began, in order."""
    return [(lifted.sender, lifted.sequence) for lifted in recording.decoded("r/lifted")]


def sent(recording: Recording) -> list[tuple[int, str, int]]:
    """Returns tick, sender and number of the lifts that were sent."""
    return [
        (header.tick, f"{worker}/worker", header.sequence)
        for worker in WORKERS
        for header in recording.headers(f"r/lift@{worker}/worker")
    ]


def restart(run: Launched, name: str) -> None:
    """Kills a component's process and waits for its successor; under losses the log may not mention it."""
    pid = run.host(name)
    os.kill(pid, signal.SIGKILL)
    run.until_true(lambda: run.host(name) != pid, f"another {name}")
    run.until_ticks(name, 10)


def test_every_command_is_executed_once_and_in_order(reference: Path) -> None:
    recording = Recording(reference)
    assert recording.gaps() == {}
    lifts = begun(recording)
    assert len(lifts) == len(set(lifts)) > TICKS // 2
    ticks = {(sender, number): tick for tick, sender, number in sent(recording)}
    assert [(ticks[each], *each) for each in lifts] == sorted((ticks[each], *each) for each in lifts)
    for worker in WORKERS:
        tally = recording.decoded(f"{worker}/tally")[-1]
        assert tally.sent > tally.ended > tally.done > 20
        sums = [
            answer.sum for answer in recording.decoded("r/sum@answers") if answer.answer.sender == f"{worker}/worker"
        ]
        assert tally.sum in (sum(sums), sum(sums[:-1]))


@pytest.mark.parametrize("hosting", ["robot", "single"])
def test_the_layout_of_processes_changes_no_message(
    launch: Launch, folder: Path, reference: Path, hosting: str
) -> None:
    run = launch(*RUN, "--hosting", hosting)
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""


@pytest.mark.parametrize("loss", ["0.02", "0.2"])
def test_lost_datagrams_change_nothing(launch: Launch, folder: Path, reference: Path, loss: str) -> None:
    run = launch(*RUN, env={"FWK_TEST_LOSS": loss})
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""
    assert "fetched" in run.text


def test_a_system_in_memory_gives_the_same_messages(folder: Path, reference: Path) -> None:
    assert difference(reference, played_in_memory(folder, FILE, TICKS, 3)) == ""


def test_a_recording_replays_byte_for_byte(reference: Path) -> None:
    replayed(reference.parent)


@pytest.mark.parametrize("loss", ["0", "0.2"])
def test_a_killed_service_repeats_no_command_and_tells_senders(launch: Launch, folder: Path, loss: str) -> None:
    run = launch(FILE, "--record", "log.lcm", env={"FWK_TEST_LOSS": loss})
    run.until_ticks("r/lifter", 10)
    for _ in range(2):
        restart(run, "r/lifter")
        restart(run, "r/adder")
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    lifts = begun(recording)
    assert len(lifts) == len(set(lifts))
    assert lifts[-1][1] > 20
    restarted = {header.writer for header in recording.headers("r/lifted")}
    assert restarted == {"r/lifter", "r/lifter#2", "r/lifter#3"}
    for worker in WORKERS:
        tally = recording.decoded(f"{worker}/tally")[-1]
        assert "failed: r/lifter was started after it had been sent" in tally.reasons
        assert tally.sent - tally.ended < 64 + 10
    if loss == "0":  # otherwise messages lost on their way die with their writer
        assert recording.gaps() == {}
        replayed(folder)


@pytest.mark.parametrize("loss", ["0", "0.2"])
def test_commands_of_a_killed_sender_are_executed_once(launch: Launch, folder: Path, loss: str) -> None:
    run = launch(FILE, "--record", "log.lcm", env={"FWK_TEST_LOSS": loss})
    run.until_ticks("one/worker", 10)
    for _ in range(2):
        restart(run, "one/worker")
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    lifts = begun(recording)
    assert len(lifts) == len(set(lifts))
    assert set(lifts) <= {(sender, number) for _, sender, number in sent(recording)}
    writers = {header.writer for header in recording.headers("r/lift@one/worker")}
    assert writers == {"one/worker", "one/worker#2", "one/worker#3"}, run.text
    assert recording.decoded("one/tally")[-1].done > 0
    if loss == "0":  # otherwise messages lost on their way die with their writer
        assert recording.gaps() == {}
        replayed(folder)


def test_futures_end_when_the_service_stays_away(launch: Launch, folder: Path) -> None:
    file = folder / FILE
    file.write_text(file.read_text().replace('Lifter" }', 'Lifter", restart: { when: never } }'))
    run = launch(FILE, "--record", "log.lcm")
    run.until_ticks("r/lifter", 10)
    os.kill(run.host("r/lifter"), signal.SIGKILL)
    run.until("r/lifter ended: killed by signal 9")
    run.until_ticks("one/worker", 100)
    run.signal(signal.SIGINT)
    assert run.wait() == 1, run.text
    tally = Recording(folder / "log.lcm").decoded("one/tally")[-1]
    assert "timed out: r/lift: was not answered in time" in tally.reasons


@pytest.fixture
def wall(folder: Path) -> Path:
    """The system in real time."""
    file = folder / FILE
    file.write_text(file.read_text().replace("speed: max", "clock: wall\nperiod_s: 0.02\nstage_time_s: 0.1"))
    return folder


def test_a_late_service_in_real_time_begins_each_command_once(launch: Launch, wall: Path) -> None:
    run = launch(FILE, "--record", "log.lcm")
    run.until_ticks("one/worker", 10)
    os.kill(run.host("r/lifter"), signal.SIGSTOP)
    run.until("r/lifter is late")
    run.until_ticks("one/worker", 20)
    os.kill(run.host("r/lifter"), signal.SIGCONT)
    run.until("r/lifter is on time again")
    run.until_ticks("r/lifter", 20)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    recording = Recording(wall / "log.lcm")
    lifts = begun(recording)
    assert len(lifts) == len(set(lifts)) > 5
    replayed(wall)


def test_losses_in_real_time_begin_no_command_twice(launch: Launch, wall: Path) -> None:
    run = launch(FILE, "--record", "log.lcm", env={"FWK_TEST_LOSS": "0.05"})
    run.until_ticks("r/lifter", 20)
    restart(run, "r/lifter")
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    lifts = begun(Recording(wall / "log.lcm"))
    assert len(lifts) == len(set(lifts)) > 5


def test_a_flood_of_commands_is_held_back_and_reported(launch: Launch, folder: Path) -> None:
    sets = ("--set", "one/worker.flood=1000", "--set", "r/lifter.ticks=1000")
    run = launch(*RUN, *sets)
    assert run.wait() == 0, run.text
    recording = Recording(folder / "log.lcm")
    assert len(recording.headers("r/lift@one/worker")) <= 64 * 2
    reasons = recording.decoded("one/tally")[-1].reasons
    assert "rejected: queue full: 64 commands to r/lift are not finished" in reasons
    replayed(folder)

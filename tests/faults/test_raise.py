"""Components with faults are named, restarted or given up, and leave nothing behind."""

import select
import signal
from pathlib import Path

import psutil
import pytest

from fwk.bus.sockets import multicast_receiver
from fwk.lcm import wire
from fwk.model.ports import Ports
from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, TICKS
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.runs import TIMEOUT_S, UNHURRIED, PortBlock, write_files

pytestmark = pytest.mark.system


@pytest.fixture
def faulty(traced: Path) -> Path:
    """The orchestra's folder; its players have further faults."""
    trouble = traced / "trouble.py"
    write_files(traced, sources("more_faults.py"))
    trouble.write_text(trouble.read_text() + "\nfrom more_faults import MORE  # noqa: E402\nMAKE |= MORE\n")
    return traced


def wrong(what: str, tick: int = 5, again: bool = False) -> list[str]:
    settings = {"trouble": what, "trouble_tick": tick, "trouble_again": str(again).lower()}
    return [word for key, value in settings.items() for word in ("--set", f"d/player.{key}={value}")]


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ("loop:long text", "d/player ended: RuntimeError: xxxx"),
        ("loop:no text", "d/player ended: RuntimeError: no text"),
        ("loop:no words", "d/player ended: HostileError"),
        ("loop:deep", "d/player ended: RecursionError: maximum recursion depth exceeded"),
        ("loop:leave in a thread", "d/player ended: it left by itself (exit code 0)"),
        ("loop:close all", "d/player ended: "),
    ],
)
def test_a_failing_component_is_named_and_restarted(
    launch: Launch, faulty: Path, after: Aftermath, what: str, says: str
) -> None:
    run = launch(*RUN, "--ticks", "20", *wrong(what))
    run.until_ticks("a/player", 2)
    after.note(run)
    recording = after.check(run, tracebacks=True)
    assert says in run.text
    assert "d/player runs again, incarnation 2" in run.text
    assert len(recording.messages["d/note"]) == 20
    assert recording.gaps() == {}


def test_a_child_program_ends_with_its_killed_component(launch: Launch, faulty: Path, after: Aftermath) -> None:
    run = launch(*RUN, *UNHURRIED, *wrong("loop:child and die"))
    run.until("d/player runs again, incarnation 2")
    after.note(run)
    child = int((faulty / "child").read_text())
    run.until_true(lambda: not alive(child), "the end of the program")
    run.signal(signal.SIGINT)
    after.check(run)


def alive(pid: int) -> bool:
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def test_a_spinning_component_in_lockstep_lets_the_run_end(launch: Launch, faulty: Path, after: Aftermath) -> None:
    run = launch(*RUN, *UNHURRIED, *wrong("loop:spin"))
    run.until_true(lambda: (faulty / "trouble-d_player").exists(), "d/player spins")
    after.note(run)
    run.signal(signal.SIGINT)
    after.check(run)
    assert "d/player did not stop when asked; killed" in run.text


def test_a_spinning_component_is_left_behind_in_real_time(launch: Launch, wall: Path, after: Aftermath) -> None:
    run = launch(*RUN, *wrong("loop:spin"))
    run.until("d/player is late")
    after.note(run)
    run.until_ticks("f/player", 10)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert len(recording.messages["f/note"]) >= len(recording.messages["d/note"]) + 10


def test_a_component_spinning_in_finalize_is_killed_and_named(launch: Launch, faulty: Path, after: Aftermath) -> None:
    run = launch(*RUN, "--ticks", str(TICKS), *wrong("finalize:spin"))
    after.check(run)
    assert "d/player did not stop when asked; killed" in run.text


def test_status_is_published_while_the_run_waits(launch: Launch, faulty: Path, ports: PortBlock) -> None:
    run = launch(*RUN, *UNHURRIED, *wrong("loop:wait"))
    run.until_true(lambda: (faulty / "trouble-d_player").exists(), "d/player waits")
    ears = multicast_receiver(Ports(ports.bus, 0, 0).status)
    for state in range(3):
        assert select.select([ears], [], [], TIMEOUT_S)[0], state
        ears.recv(wire.DATAGRAM_MAX)
    ears.close()
    (faulty / "go-on").touch()
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text

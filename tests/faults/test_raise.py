"""Components with faults are named, restarted or given up, and leave nothing behind."""

import select
import signal
from itertools import chain, product
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
from tests.programs.orchestra import STAGES

pytestmark = pytest.mark.system


@pytest.fixture
def faulty(traced: Path) -> Path:
    """The orchestra's folder; its players have further faults."""
    trouble = traced / "trouble.py"
    write_files(traced, sources("more_faults.py"))
    trouble.write_text(trouble.read_text() + "\nfrom more_faults import MORE  # noqa: E402\nMAKE |= MORE\n")
    return traced


def wrong(what: str, tick: int = 5, again: bool = False, player: str = "d") -> list[str]:
    settings = {"trouble": what, "trouble_tick": tick, "trouble_again": str(again).lower()}
    return [word for key, value in settings.items() for word in ("--set", f"{player}/player.{key}={value}")]


FAULTS = {
    "a": ("loop:long text", "RuntimeError: xxxx"),
    "b": ("loop:no text", "RuntimeError: no text"),
    "c": ("loop:no words", "HostileError"),
    "d": ("loop:deep", "RecursionError: maximum recursion depth exceeded"),
    "e": ("loop:leave in a thread", "it left by itself (exit code 0)"),
    "f": ("loop:close all", ""),
}
"""Player to its fault and the report of its end."""


def test_failing_components_are_named_and_restarted(launch: Launch, faulty: Path, after: Aftermath) -> None:
    wrongs = [wrong(what, 5 + 2 * n, player=player) for n, (player, (what, _)) in enumerate(FAULTS.items())]
    run = launch(*RUN, *UNHURRIED, *chain(*wrongs))
    run.until("f/player runs again, incarnation 2")
    run.until_ticks("f/player", 3)
    after.note(run)
    run.signal(signal.SIGINT)
    recording = after.check(run, tracebacks=True)
    last = recording.records[-1].tick - 1  # the end may come in the middle of a tick
    text_log = (run.run_dir / "fwk.log").read_text()  # the console throttles floods
    for player, (_, says) in FAULTS.items():
        assert f"{player}/player ended: {says}" in text_log
        assert f"{player}/player runs again, incarnation 2" in text_log
        places = [(header.tick, header.stage) for header in recording.headers(f"{player}/note")]
        assert [each for each in places if each[0] <= last] == [*product(range(1, last + 1), STAGES[player])]
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
    run.until_true(lambda: (wall / "trouble-d_player").exists(), "d/player spins")
    run.until("d/player is late")
    after.note(run)
    run.until_true(lambda: run.tick("f/player") >= run.tick("d/player") + 10, "f/player goes on")
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert recording.headers("f/note")[-1].tick > recording.headers("d/note")[-1].tick


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

"""Failures of processes are named, leave nothing behind, and never hang the run."""

import os
import signal
from pathlib import Path

import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import UNHURRIED, Launched, pause

pytestmark = pytest.mark.system

FILE = "launch/orchestra.yaml"
STOP_S = 5.0
ORPHAN_S = 2.0


@pytest.fixture
def traced(folder: Path) -> Path:
    """The orchestra's folder, in which players write their process ids and ticks."""
    (folder / "traces").mkdir()
    return folder


def trouble(what: str, tick: int = 5, again: bool = False) -> list[str]:
    """Returns settings that give `d/player` a fault."""
    settings = {"trouble": what, "trouble_tick": tick, "trouble_again": str(again).lower()}
    return [word for key, value in settings.items() for word in ("--set", f"d/player.{key}={value}")]


def running(launch: Launch, *arguments: str) -> Launched:
    """A run without an end of its own, some ticks old."""
    run = launch(FILE, "--record", "log.lcm", *UNHURRIED, *arguments)
    run.until_ticks("f/player", 3)
    return run


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.core
def test_a_signal_to_stop_ends_the_run_cleanly(launch: Launch, traced: Path, number: signal.Signals) -> None:
    run = running(launch)
    run.signal(number)
    assert run.wait(STOP_S) == 0, run.text
    assert run.gone_within(0.5)
    assert "orchestra: interrupted" in run.text
    assert "Traceback" not in run.text
    assert Recording(traced / "log.lcm").gaps() == {}


def test_a_component_that_ignores_sigterm_is_killed_and_named(launch: Launch, traced: Path) -> None:
    run = launch(FILE, *trouble("loop:ignore"))
    run.until_true(lambda: (traced / "ignoring").exists(), "d/player ignores signals")
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    assert run.gone_within(0.5)
    assert "d/player did not stop when asked; killed" in run.text


def test_a_killed_supervisor_ends_all_and_leaves_a_log(launch: Launch, traced: Path) -> None:
    run = running(launch)
    pause(1.2)  # the recorder writes once a second
    os.kill(run.process.pid, signal.SIGKILL)
    assert run.gone_within(ORPHAN_S), run.processes()
    recording = Recording(traced / "log.lcm")
    assert len(recording.messages["f/note"]) >= 3
    assert recording.gaps() == {}


@pytest.mark.core
def test_a_killed_component_is_named_and_the_run_goes_on(launch: Launch, traced: Path) -> None:
    run = running(launch)
    os.kill(run.host("c/player"), signal.SIGKILL)
    run.until("c/player ended: killed by signal 9; restart in")
    run.until("c/player runs again, incarnation 2")
    run.until_ticks("f/player", 3)
    run.signal(signal.SIGINT)
    assert run.wait(STOP_S) == 0, run.text
    assert Recording(traced / "log.lcm").gaps() == {}


@pytest.mark.parametrize("victim", ["zygote", "gateway"])
def test_a_killed_framework_process_ends_the_run_with_a_reason(launch: Launch, traced: Path, victim: str) -> None:
    run = running(launch)
    os.kill(run.zygote() if victim == "zygote" else run.gateway(), signal.SIGKILL)
    assert run.wait(STOP_S) == 1, run.text
    assert run.gone_within(ORPHAN_S)
    assert f"orchestra: broken: the {victim} ended: killed by signal 9" in run.text
    assert "Traceback" not in run.text


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ("init:raise", "d/player: RuntimeError: a wrong note"),
        ("init:exit", "d/player: SystemExit: 0"),
        ("init:os._exit", "d/player: exit code 3"),
        ("init:kill", "d/player: killed by signal 9"),
    ],
)
def test_a_component_that_does_not_start_is_named(launch: Launch, folder: Path, what: str, says: str) -> None:
    run = launch(FILE, *trouble(what))
    assert run.wait() == 1, run.text
    assert run.gone_within(0.5)
    assert "not started" in run.text
    assert says in run.text
    assert "; restart in " not in run.text
    assert "c/player:" not in run.text


def test_a_component_that_is_not_ready_in_time_is_named(launch: Launch, folder: Path) -> None:
    file = folder / FILE
    file.write_text(file.read_text().replace("d/player: {", "d/player: { ready_timeout_s: 3,"))
    run = launch(FILE, *trouble("init:wait"))
    assert run.wait() == 1, run.text
    assert run.gone_within(0.5)
    assert "d/player: not ready after 3 s; still in init: d/player" in run.text


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ("loop:raise", "d/player ended: RuntimeError: a wrong note"),
        ("loop:exit", "d/player ended: SystemExit: 0"),
        ("loop:exit text", "d/player ended: SystemExit: enough"),
        ("loop:give up", "d/player ended: GiveUp: no more"),
        ("loop:os._exit", "d/player ended: exit code 3"),
        ("loop:leave", "d/player ended: it left by itself (exit code 0) without having been asked to"),
        ("loop:crash", "d/player ended: killed by signal 11"),
    ],
)
def test_a_component_that_fails_once_is_restarted(launch: Launch, folder: Path, what: str, says: str) -> None:
    run = launch(FILE, *trouble(what), "--ticks", "8", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    assert says in run.text
    assert "d/player runs again, incarnation 2" in run.text
    assert len(Recording(folder / "log.lcm").messages["d/note"]) == 8


@pytest.mark.parametrize(("limit", "starts"), [("when: never", 1), ("limit: 2, backoff_s: 0.01", 3)])
def test_the_run_goes_on_after_the_last_allowed_restart(launch: Launch, folder: Path, limit: str, starts: int) -> None:
    file = folder / FILE
    file.write_text(file.read_text().replace("d/player: {", f"d/player: {{ restart: {{ {limit} }},"))
    run = launch(FILE, *trouble("loop:raise", again=True), "--ticks", "8", "--record", "log.lcm")
    assert run.wait() == 1, run.text
    assert run.text.count("d/player ended: ") == starts
    assert "orchestra: failed: d/player: RuntimeError: a wrong note" in run.text
    recording = Recording(folder / "log.lcm")
    assert len(recording.messages["d/note"]) == 4
    assert len(recording.messages["f/note"]) == 8


def test_a_failure_in_finalize_is_named(launch: Launch, folder: Path) -> None:
    run = launch(FILE, *trouble("finalize:raise"), "--ticks", "5")
    assert run.wait() == 1, run.text
    assert "orchestra: failed: d/player: RuntimeError: a wrong note" in run.text
    assert "in finalize" in run.text


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ("init:crash", "strings: c/player: killed by signal 11"),
        ("init:raise", "strings: c/player: RuntimeError: a wrong note"),
        ("loop:crash", "strings ended: c/player: killed by signal 11"),
        ("loop:kill", "strings ended: c/player: killed by signal 9"),
        ("loop:raise", "strings ended: c/player: RuntimeError: a wrong note"),
        ("loop:os._exit", "strings ended: c/player: exit code 3"),
    ],
)
def test_a_crash_in_a_shared_host_names_cause_and_victims(launch: Launch, folder: Path, what: str, says: str) -> None:
    file = folder / FILE
    file.write_text(file.read_text() + "hosts: {strings: [a/player, c/player, e/player]}\n")
    sets = [word.replace("d/player", "c/player") for word in trouble(what)]
    run = launch(FILE, *sets, "--ticks", "8", "--record", "log.lcm")
    assert run.wait() == (1 if "init" in what else 0), run.text
    assert says in run.text
    if "loop" in what:
        assert "; its process also held a/player, e/player; restart in" in run.text
        assert "strings runs again, incarnation 2" in run.text
        assert len(Recording(folder / "log.lcm").messages["e/note"]) == 8


def test_printed_lines_are_logged_with_the_component_name(launch: Launch, folder: Path) -> None:
    run = launch(FILE, *trouble("loop:print"), "--ticks", "8")
    assert run.wait() == 0, run.text
    assert "d/player: words on standard output (stdout:1)" in run.text
    assert "d/player: words on standard error (stderr:1)" in run.text


def test_a_second_run_on_the_same_ports_is_refused(launch: Launch, traced: Path) -> None:
    first = running(launch)
    second = launch(FILE, "--ticks", "1")
    assert second.wait() == 2
    assert "are used by another run" in second.text
    assert [path.name.endswith(f"-{first.process.pid}") for path in first.run_dir.parent.iterdir()] == [True]
    first.until_ticks("f/player", 3)
    first.signal(signal.SIGINT)
    assert first.wait(STOP_S) == 0, first.text
    assert "refused" not in first.text

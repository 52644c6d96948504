"""Runs that end badly: nothing is left of them, and the reason is reported."""

import contextlib
import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN
from tests.harness.fixtures import Launch
from tests.harness.runs import Launched

pytestmark = pytest.mark.system

WHO: dict[str, Callable[[Launched], int]] = {
    "gateway": lambda run: run.gateway(),
    "zygote": lambda run: run.zygote(),
}


@pytest.mark.parametrize("who", WHO)
def test_a_process_that_dies_during_shutdown_is_named(launch: Launch, traced: Path, after: Aftermath, who: str) -> None:
    run = launch(*RUN, "--set", "d/player.trouble=finalize:wait")
    run.until_ticks("f/player", 5)
    after.note(run)
    victim = WHO[who](run)
    run.signal(signal.SIGINT)
    run.until_true((traced / "trouble-d_player").exists, "d/player finalizes")
    os.kill(victim, signal.SIGKILL)
    (traced / "go-on").touch()
    after.check(run, code=1)
    assert f"the {who} ended: killed by signal 9 while everything was being stopped" in run.text


def test_sigterm_to_all_processes_ends_the_run_cleanly(launch: Launch, traced: Path, after: Aftermath) -> None:
    """systemd stops a service this way."""
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    for pid in [run.zygote(), *(process.pid for process in run.processes())]:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGTERM)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert "broken" not in run.text


def test_a_stopped_host_is_no_orphan_of_a_killed_supervisor(launch: Launch, traced: Path, after: Aftermath) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    for process in run.processes():
        if process.pid != run.process.pid:
            os.kill(process.pid, signal.SIGSTOP)
    run.signal(signal.SIGKILL)
    after.check(run, code=-signal.SIGKILL)


def test_repeated_ctrl_c_ends_the_run_cleanly(launch: Launch, traced: Path, after: Aftermath) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    with contextlib.suppress(ProcessLookupError):  # it may end between the look and the signal
        while run.process.poll() is None:
            run.signal(signal.SIGINT)
    after.check(run)

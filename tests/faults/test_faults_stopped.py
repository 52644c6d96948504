"""Processes that stand still for three seconds (SIGSTOP): lockstep waits for them, real time goes on without them."""

import contextlib
import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.faults.conftest import RUN, TICKS
from tests.faults.faults_after import Aftermath
from tests.system.conftest import Launch
from tests.system.system_runs import Launched, pause

pytestmark = pytest.mark.system

STILL_S = 3.0
WHO: dict[str, Callable[[Launched], int]] = {
    "a component": lambda run: run.host("d/player"),
    "the supervisor": lambda run: run.process.pid,
    "the gateway": lambda run: run.gateway(),
    "the zygote": lambda run: run.zygote(),
}


@pytest.mark.parametrize("who", WHO)
def test_in_lockstep_nothing_shows_that_somebody_stood_still(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, who: str
) -> None:
    run = launch(*RUN, "--ticks", str(TICKS))
    run.until_ticks("f/player", 5)
    after.note(run)
    still = WHO[who](run)
    os.kill(still, signal.SIGSTOP)
    pause(STILL_S)
    with contextlib.suppress(ProcessLookupError):  # a run that needed no new process has ended, and woken the zygote
        os.kill(still, signal.SIGCONT)
    recording = after.check(run, equal_to=undisturbed)
    assert recording.gaps() == {}
    assert "lost 0" in run.text


def test_in_lockstep_everybody_waits(launch: Launch, traced: Path, after: Aftermath) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    os.kill(run.host("d/player"), signal.SIGSTOP)
    pause(0.5)
    before = run.tick("a/player")
    pause(STILL_S - 0.5)
    assert run.tick("a/player") == before
    os.kill(run.host("d/player"), signal.SIGCONT)
    run.until_ticks("f/player", 5)
    run.signal(signal.SIGINT)
    after.check(run)


@pytest.mark.parametrize("who", ["a component", "the supervisor"])
def test_in_real_time_the_run_goes_on(launch: Launch, wall: Path, after: Aftermath, who: str) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    still = WHO[who](run)
    os.kill(still, signal.SIGSTOP)
    if who == "a component":
        run.until("d/player is late")
        run.until_ticks("f/player", 10)  # the others go on
    pause(STILL_S)
    os.kill(still, signal.SIGCONT)
    run.until_ticks("d/player", 5)
    run.until_ticks("f/player", 5)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    if who == "a component":
        assert "d/player is on time again" in run.text


@pytest.mark.parametrize("who", ["a component", "the gateway", "the zygote"])
def test_who_stands_still_is_woken_to_end_well(launch: Launch, traced: Path, after: Aftermath, who: str) -> None:
    run = launch(*RUN)
    run.until_ticks("f/player", 5)
    after.note(run)
    os.kill(WHO[who](run), signal.SIGSTOP)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert "killed" not in run.text

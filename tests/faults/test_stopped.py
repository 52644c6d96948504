"""Processes stopped for three seconds (SIGSTOP): lockstep waits for them, real time goes on without them."""

import contextlib
import os
import re
import signal
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from fwk.model.tick_events import MessageLost
from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, TICKS, WAITS, until_it_waits
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import UNHURRIED, Launched, PortBlock, pause, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

STILL_S = 3.0
WHO: dict[str, Callable[[Launched], int]] = {
    "a component": lambda run: run.host("d/player"),
    "the supervisor": lambda run: run.process.pid,
    "the gateway": lambda run: run.gateway(),
    "the zygote": lambda run: run.zygote(),
}


@pytest.mark.parametrize("stops", [["a component", "the supervisor", "the gateway"], ["the zygote"]], ids=len)
def test_a_stopped_process_in_lockstep_leaves_no_trace(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, stops: list[str]
) -> None:
    """The processes are stopped one after another; when the last one continues, so does the run, perhaps to its end."""
    run = launch(*RUN, "--ticks", str(TICKS), *WAITS)
    until_it_waits(run)
    after.note(run)
    pids = [WHO[each](run) for each in stops]
    os.kill(pids[0], signal.SIGSTOP)
    (traced / "go-on").touch()
    for still, following in zip(pids, (*pids[1:], 0), strict=True):
        pause(STILL_S)
        if following:
            os.kill(following, signal.SIGSTOP)  # before the run goes on
        with contextlib.suppress(ProcessLookupError):  # a run without restarts ends and wakes the zygote
            os.kill(still, signal.SIGCONT)
    recording = after.check(run, equal_to=undisturbed)
    assert recording.gaps() == {}
    assert "lost 0" in run.text


def test_lockstep_waits_for_a_stopped_component(
    launch: Launch, traced: Path, ports: PortBlock, after: Aftermath
) -> None:
    run = launch(*RUN, *UNHURRIED)
    run.until_ticks("f/player", 5)
    after.note(run)
    os.kill(run.host("d/player"), signal.SIGSTOP)
    steered = Steered(run, ports)
    run.until_true(lambda: steered.ask("status")["waits_for"] == ["d/player"], "that d/player alone is waited for")
    before = run.tick("a/player")
    pause(STILL_S)
    assert run.tick("a/player") == before
    os.kill(run.host("d/player"), signal.SIGCONT)
    run.until_ticks("f/player", 5)
    run.signal(signal.SIGINT)
    after.check(run)


def test_status_names_a_stopped_gateway(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = Steered(launch(*RUN, *UNHURRIED), ports)
    gateway = run.launched.gateway()
    os.kill(gateway, signal.SIGSTOP)
    run.launched.until_true(lambda: run.ask("status")["waits_for"] == ["gateway"], "that the gateway is waited for")
    os.kill(gateway, signal.SIGCONT)
    run.ticks_pass()
    run.end()


@pytest.mark.parametrize("who", ["a component", "the supervisor"])
def test_real_time_goes_on_without_a_stopped_process(launch: Launch, wall: Path, after: Aftermath, who: str) -> None:
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
def test_a_stopped_process_is_woken_to_end_cleanly(launch: Launch, traced: Path, after: Aftermath, who: str) -> None:
    run = launch(*RUN, *UNHURRIED)
    run.until_ticks("f/player", 5)
    after.note(run)
    os.kill(WHO[who](run), signal.SIGSTOP)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert recording.gaps() == {}
    assert "killed" not in run.text


@pytest.fixture
def losing(traced: Path) -> list[str]:
    """Settings with which `d/player` loses its messages of tick 5 and stops."""
    trouble = traced / "trouble.py"
    write_files(traced, sources("losing.py"))
    trouble.write_text(trouble.read_text() + "\nfrom losing import MORE  # noqa: E402\nMAKE |= MORE\n")
    settings = {"trouble": "loop:lose", "trouble_tick": 5}
    return [word for key, value in settings.items() for word in ("--set", f"d/player.{key}={value}")]


def until_still(run: Launched) -> int:
    """Waits until `d/player` has stopped; returns its process."""
    run.until_ticks("d/player", 5)
    process = psutil.Process(run.host("d/player"))
    run.until_true(lambda: process.status() == psutil.STATUS_STOPPED, "d/player stands still")
    return process.pid


def test_lockstep_waits_for_messages_lost_by_a_stopped_host(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, losing: list[str]
) -> None:
    run = launch(*RUN, "--ticks", str(TICKS), *losing)
    still = until_still(run)
    after.note(run)
    pause(2.0)
    assert run.tick("a/player") == 5
    os.kill(still, signal.SIGCONT)
    recording = after.check(run)
    assert recording.messages == Recording(undisturbed).messages
    assert "lost 0" in run.text


def test_messages_lost_in_real_time_are_reported_and_replayed(
    launch: Launch, wall: Path, after: Aftermath, losing: list[str]
) -> None:
    run = launch(*RUN, *losing)
    still = until_still(run)
    after.note(run)
    run.until_ticks("f/player", 120)  # more than the main loop's lead over the gateway
    assert psutil.Process(still).status() == psutil.STATUS_STOPPED
    os.kill(still, signal.SIGCONT)
    run.until_ticks("d/player", 5)
    run.signal(signal.SIGINT)
    recording = after.check(run)
    assert {"d/note"} <= recording.gaps().keys() <= {"d/note", "d/burst"}
    assert "gateway: d/note: 1 messages of 5 to 5 are lost and not in the recording" in run.text
    assert "f/player: d/note: 1 messages of 5 to 5 lost" in run.text
    assert re.search(r"messages and ticks: lost [1-9]", run.text), run.text
    assert re.search(r"recording: .*log.lcm; \d messages are missing in it", run.text), run.text
    lost = [event for _, event in recording.events if isinstance(event, MessageLost)]
    assert {(event.host, event.sequence) for event in lost} >= {(host, 5) for host in (0, 1, 2, 4, 5)}

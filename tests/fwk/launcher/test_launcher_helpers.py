"""The helper processes at the end of a run, played by other programs."""

import os
import socket
import threading

import pytest

from fwk.gateway.gateway import FINISHING
from fwk.launcher import helper_processes
from fwk.launcher.helper_processes import HelperProcesses
from fwk.launcher.run import ending
from fwk.recording.sinks import LOST
from tests.harness.runs import pause


def played(gateway: str) -> tuple[HelperProcesses, socket.socket]:
    """Returns the helper processes of a run, played by programs, and the gateway's end of `control`."""
    helpers = object.__new__(HelperProcesses)
    helpers.control, connection = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    helpers.gave_up, helpers._watcher = "", 0
    helpers._gateway = os.posix_spawn("/bin/sh", ["sh", "-c", f"exec {gateway}"], os.environ)
    helpers._display = os.posix_spawn("/bin/true", ["true"], os.environ)
    return helpers, connection


def test_a_gateway_that_hangs_at_its_end_is_killed_and_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helper_processes, "_PATIENCE_S", 0.2)
    helpers, gateway = played("sleep 60")
    with helpers.control, gateway:
        gateway.send(LOST.encode() + b"\x003")
        gateway.send(b"unwritten\0no recording")
        newest = helpers.stop()
    assert (newest, helpers.lost, helpers.deleted, helpers.unwritten) == ({}, 3, "", "no recording")
    assert helpers.gave_up == "the gateway was not done 0.2 s after the end; killed: the recording may lack its end"


def test_a_gateway_that_still_publishes_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helper_processes, "_PATIENCE_S", 1.0)
    helpers, gateway = played("true")

    def publish() -> None:
        for _ in range(10):
            pause(0.2)
            gateway.send(FINISHING)
        gateway.send(LOST.encode() + b"\x000")
        gateway.close()

    publishing = threading.Thread(target=publish)
    publishing.start()
    with helpers.control:
        assert helpers.stop() == {}
    publishing.join()
    assert helpers.gave_up == ""


@pytest.mark.parametrize(
    ("reason", "found", "ends"),
    [
        ("9 ticks done", {}, ("9 ticks done", False)),
        ("9 ticks done", {"deleted": "the log was deleted"}, ("broken: the log was deleted", True)),
        ("9 ticks done", {"unwritten": "it lacks 7 messages"}, ("9 ticks done, but it lacks 7 messages", True)),
        ("interrupted", {"unwritten": "it lacks 7 messages"}, ("interrupted", False)),
    ],
)
def test_what_helpers_report_decides_how_a_run_ends(reason: str, found: dict[str, str], ends: tuple[str, bool]) -> None:
    helpers = object.__new__(HelperProcesses)
    helpers.gave_up = helpers.deleted = helpers.unwritten = ""
    vars(helpers).update(found)
    assert ending(reason, helpers) == ends

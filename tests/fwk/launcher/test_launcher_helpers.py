"""The helper processes at the end of a run, played by other programs."""

import os
import socket

import pytest

from fwk.launcher import helper_processes
from fwk.launcher.helper_processes import HelperProcesses
from fwk.recording.sinks import LOST


def test_a_gateway_that_hangs_at_its_end_is_killed_and_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helper_processes, "_PATIENCE_S", 0.2)
    helpers = object.__new__(HelperProcesses)
    helpers.control, gateway = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    helpers.gave_up, helpers._watcher = "", 0
    helpers._gateway = os.posix_spawn("/bin/sleep", ["sleep", "60"], os.environ)
    helpers._display = os.posix_spawn("/bin/true", ["true"], os.environ)
    with helpers.control, gateway:
        gateway.send(LOST.encode() + b"\x003")
        newest = helpers.stop()
    assert (newest, helpers.lost, helpers.deleted) == ({}, 3, "")
    assert helpers.gave_up == "the gateway was not done 0.2 s after the end; killed: the recording may lack its end"

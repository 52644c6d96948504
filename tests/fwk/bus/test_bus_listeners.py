"""Programs that listen on a port, and whether they keep up with what they receive."""

import gc
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fwk.bus import listeners
from fwk.bus.listeners import LOOK_US, Listeners
from fwk.clock import sleep_s

LISTENER = """
import socket, sys
listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
listener.bind(("127.0.0.1", 0))
print(listener.getsockname()[1], flush=True)
listener.recv(100)
print("works", flush=True)
while True:
    pass
"""


@contextmanager
def listening() -> Iterator[tuple[subprocess.Popen[str], int]]:
    """A program that waits for a datagram at a port, and is busy from then on."""
    command = [sys.executable, "-c", LISTENER]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout
        try:
            yield program, int(program.stdout.readline())
        finally:
            program.kill()


def busy_within(made: Listeners, seconds: float) -> str:
    for _ in range(round(seconds / 0.01)):
        if names := made.busy():
            return names[0]
        sleep_s(0.01)
    return ""


def idle_within(made: Listeners, seconds: float) -> bool:
    for _ in range(round(seconds / 0.01)):
        if not made.busy():
            return True
        sleep_s(0.01)
    return False


def test_a_listener_is_busy_while_it_works() -> None:
    with listening() as (program, port):
        made = Listeners(port)
        assert idle_within(made, 5.0)  # it has yet to begin its wait
        assert busy_within(made, 0.2) == ""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"work", ("127.0.0.1", port))
        assert program.stdout
        assert program.stdout.readline() == "works\n"
        assert str(program.pid) in busy_within(made, 5.0)
        program.kill()
        program.wait()
        assert busy_within(made, 0.2) == ""
        made.close()


def test_a_listener_that_comes_later_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    now_us = [1_000_000]
    monkeypatch.setattr(listeners, "monotonic_us", lambda: now_us[0])
    with listening() as (program, port):
        made = Listeners(port + 1 if port < 65535 else port - 1)
        made.busy()
        made._port = port
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"work", ("127.0.0.1", port))
        assert program.stdout
        program.stdout.readline()
        assert made.busy() is None
        now_us[0] += LOOK_US
        assert str(program.pid) in busy_within(made, 5.0)
        made.close()


def test_an_expected_listener_is_looked_for_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listeners, "monotonic_us", lambda: 1_000_000)
    made = Listeners(9)
    assert made.busy() is None
    with listening() as (_, port):
        made._port = port
        assert made.busy() is None
        made.expect()
        assert made.busy() is not None
        made.close()


def test_listeners_may_exist_that_the_kernel_does_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listeners, "sockets_on", lambda _: [])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.bind(("127.0.0.1", 0))
        made = Listeners(own.getsockname()[1], os.fstat(own.fileno()).st_ino)
        assert made.busy() == []


def test_this_process_is_not_a_listener_of_its_own() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.bind(("127.0.0.1", 0))
        made = Listeners(own.getsockname()[1], os.fstat(own.fileno()).st_ino)
        assert made.busy() is None
        made.close()


def test_closed_listeners_leave_no_descriptor() -> None:
    gc.collect()  # what earlier tests left behind is not closed in between
    before = len(os.listdir("/proc/self/fd"))
    with listening() as (_, port):
        made = Listeners(port)
        made.busy()
        made.close()
    assert len(os.listdir("/proc/self/fd")) == before

"""Control sockets of programs that are not runs."""

import contextlib
import os
import socket
import threading
from collections.abc import Callable, Iterator
from itertools import count

import pytest

_NUMBERS = count()


@pytest.fixture
def bound() -> Iterator[list[socket.socket]]:
    made: list[socket.socket] = []
    yield made
    for each in made:
        with contextlib.suppress(OSError):  # not connected
            each.shutdown(socket.SHUT_RDWR)  # wakes the thread that accepts
        each.close()


@pytest.fixture
def fake(bound: list[socket.socket]) -> Callable[[bytes], str]:
    """Makes the control socket of a program that sends these bytes to every client; returns its address."""

    def make(sent: bytes) -> str:
        listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        bound.append(listening)
        listening.bind(f"\0fwk-control-test-{os.getpid()}-{next(_NUMBERS)}")  # a waiting thread keeps a closed one
        listening.listen()

        def serve() -> None:
            with contextlib.suppress(OSError):
                while True:
                    connection, _ = listening.accept()
                    bound.append(connection)
                    connection.sendall(sent)

        threading.Thread(target=serve, daemon=True).start()
        return str(listening.getsockname().decode())

    return make

"""The thread that serves other processes only while an iteration runs."""

import os
import threading

from fwk.bus.sender import NEVER_US
from fwk.host.background_server import BackgroundServer

TIMEOUT_S = 30


def test_background_thread_handles_input_only_while_serving() -> None:
    read, write = os.pipe()
    os.set_blocking(read, False)
    handled = threading.Event()
    threads: list[int] = []

    def handle() -> int:
        if source.read(1):
            threads.append(threading.get_ident())
            handled.set()
        return NEVER_US

    server, source = BackgroundServer(), os.fdopen(read, "rb", buffering=0)
    os.write(write, b"1")
    for _ in range(3):
        handled.clear()
        with server.serving(source, handle):
            assert handled.wait(TIMEOUT_S)
        before = len(threads)
        os.write(write, b"2")
        assert len(threads) == before
    assert threading.get_ident() not in threads
    assert len(set(threads)) == 1
    source.close()

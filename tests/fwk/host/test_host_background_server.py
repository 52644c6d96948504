"""The thread that answers others while an iteration runs, and only then."""

import os
import threading

from fwk.host.background_server import Attendant

TIMEOUT_S = 30


def test_it_handles_what_comes_while_it_serves_and_nothing_afterwards() -> None:
    read, write = os.pipe()
    os.set_blocking(read, False)
    handled = threading.Event()
    threads: list[int] = []

    def handle() -> None:
        os.read(read, 1)
        threads.append(threading.get_ident())
        handled.set()

    attendant = Attendant(read, handle)
    os.write(write, b"1")
    for _ in range(3):
        handled.clear()
        with attendant.serving():
            assert handled.wait(TIMEOUT_S)
        before = len(threads)
        os.write(write, b"2")
        assert len(threads) == before
    assert threading.get_ident() not in threads
    assert len(set(threads)) == 1

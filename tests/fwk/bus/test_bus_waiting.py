"""Waiting for sockets."""

import socket

from fwk.bus.waiting import Waiting


def test_a_wait_of_any_length_is_accepted() -> None:
    waiting, (here, there) = Waiting(), socket.socketpair()
    waiting.add(here)
    there.send(b"x")
    assert waiting.wait(10**30) == [here.fileno()]
    waiting.close()
    here.close()
    there.close()

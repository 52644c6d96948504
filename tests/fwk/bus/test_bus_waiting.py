"""Waiting for sockets."""

import socket

from fwk.bus.waiting import Waiting


def test_no_time_is_too_long_to_wait_for() -> None:
    waiting, (here, there) = Waiting(), socket.socketpair()
    waiting.add(here)
    there.send(b"x")
    assert waiting.wait(10**30) == [here.fileno()]
    waiting.close()
    here.close()
    there.close()

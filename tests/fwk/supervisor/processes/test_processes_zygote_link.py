"""The protocol between supervisor and zygote, on a socket pair without a zygote."""

import os
import socket
from collections.abc import Iterator

import pytest

from fwk.engine.assignment import Start
from fwk.supervisor.processes.starter import Ended, Started
from fwk.supervisor.processes.zygote_link import (
    SignalRequest,
    StartRequest,
    SupervisorEnd,
    ZygoteEnd,
    ZygoteEndedError,
)

Ends = tuple[SupervisorEnd, ZygoteEnd]


@pytest.fixture
def ends() -> Iterator[Ends]:
    first, second = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    yield SupervisorEnd(first), ZygoteEnd(second)
    first.close()
    second.close()


def test_requests_arrive_as_they_were_sent(ends: Ends) -> None:
    supervisor, zygote = ends
    start = Start(2, {"r/imu": 7}, {"r/base": "{}"}, "[]", 3, 40, 2_000_000)
    requests: list[StartRequest | SignalRequest] = [StartRequest(5, start, True), SignalRequest(100, 15)]
    for request in requests:
        supervisor.send(request)
    assert [zygote.receive(), zygote.receive()] == requests


def test_events_arrive_in_order_with_the_streams_of_the_process(ends: Ends) -> None:
    supervisor, zygote = ends
    read, write = os.pipe()
    zygote.send(Started(5, 2, 100, (read, write)))
    zygote.send(Ended(5, 2, 100, -11, core=True))
    started, ended = supervisor.events()
    assert ended == Ended(5, 2, 100, -11, core=True)
    assert isinstance(started, Started)
    assert started.streams
    os.write(started.streams[1], b"hello")
    assert os.read(read, 5) == b"hello"
    for descriptor in (read, write, *started.streams):
        os.close(descriptor)
    assert supervisor.events() == []


def test_each_end_notices_that_the_other_has_closed(ends: Ends) -> None:
    supervisor, zygote = ends
    zygote.close()
    with pytest.raises(ZygoteEndedError):
        supervisor.events()
    supervisor.send(SignalRequest(100, 9))


def test_the_zygote_notices_that_the_supervisor_has_ended(ends: Ends) -> None:
    supervisor, zygote = ends
    supervisor.close()
    assert zygote.receive() is None

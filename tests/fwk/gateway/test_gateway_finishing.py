"""The gateway at the end of a run: what still waits for the public bus, while the supervisor waits for the gateway."""

import itertools
import socket
from collections.abc import Iterator

import pytest

from fwk.bus.network import Steps, T, UdpNetwork
from fwk.gateway.gateway import FINISH_US, FINISHING, FINISHING_US, PATIENCE_US, Gateway
from fwk.gateway.pacing import LEAST
from lcmtypes.core import log_t
from tests.fwk.host.host_parts import plan
from tests.harness.runs import PortBlock

RUN = 4711
BUSY_US = PATIENCE_US - 100_000


class QuickNetwork(UdpNetwork):
    """A network whose time jumps to the end of each wait."""

    time_us = 0

    def now_us(self) -> int:
        return self.time_us

    def run(self, steps: Steps[T]) -> T:
        until_us = next(steps)
        try:
            while True:
                ready = self._waiting.wait(0)
                self.time_us = self.time_us if ready else max(self.time_us, until_us)
                until_us = steps.send(ready)
        except StopIteration as end:
            result: T = end.value
            return result


class Ending:
    """A gateway whose supervisor has ended the run, and a slow listener on the public bus."""

    def __init__(self, base: int) -> None:
        self.supervisor, self._theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.supervisor.setblocking(False)
        self._theirs.setblocking(False)
        self._outside = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.network = QuickNetwork()
        self.gateway = Gateway(plan(base), RUN, self.network, self._theirs, self)
        self.gateway.sinks.append(self)
        self.sent: list[int] = []
        self.lines: list[str] = []
        self.reports: list[int] = []
        self.closed = False

    def fileno(self) -> int:
        return self._outside.fileno()

    def receive(self) -> None:
        return None

    def send(self, _: bytes) -> None:
        self.sent.append(self.network.time_us)

    def busy_listeners(self) -> list[str]:
        """Handles what it gets only after a time just below the gateway's patience."""
        self._take_report()
        return ["slow"] if self.sent and self.network.time_us < self.sent[-1] + BUSY_US else []

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        assert not self.closed
        if channel == "fwk/log":
            self.lines.append(log_t.decode(data).text)

    def tick(self) -> None:
        pass

    def close(self) -> None:
        self.closed = True

    def end(self, datagrams: int) -> None:
        self.gateway.publisher.put([b"datagram"] * datagrams)
        self.supervisor.shutdown(socket.SHUT_WR)
        self.network.run(self.gateway.serve())
        for each in (self.supervisor, self._theirs, self._outside):
            each.close()
        self.network.close()

    def _take_report(self) -> None:
        try:
            assert self.supervisor.recv(100) == FINISHING
        except BlockingIOError:
            return
        self.reports.append(self.network.time_us)


@pytest.fixture
def ending(ports: PortBlock) -> Iterator[Ending]:
    made = Ending(ports.bus)
    yield made
    assert made.closed


def test_the_rest_keeps_the_pace_of_the_listener(ending: Ending) -> None:
    ending.end(5 * LEAST)
    assert len(ending.sent) == 5 * LEAST
    assert len(set(ending.sent)) == 5
    assert ending.lines == []


def test_the_supervisor_hears_of_the_work_all_the_time(ending: Ending) -> None:
    ending.end(5 * LEAST)
    assert ending.sent[-1] > 3 * BUSY_US
    times = [ending.sent[0], *ending.reports, ending.sent[-1]]
    assert max(after - before for before, after in itertools.pairwise(times)) < 2 * FINISHING_US


def test_a_rest_sent_too_fast_at_the_end_is_reported(ending: Ending) -> None:
    ending.end(20 * LEAST)
    assert len(ending.sent) == 20 * LEAST
    assert FINISH_US <= ending.sent[-1] < FINISH_US + PATIENCE_US
    assert ending.lines == ["public bus: slow does not keep up; it may lack messages"]

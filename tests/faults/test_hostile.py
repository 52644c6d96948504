"""A run survives garbled copies of its own datagrams and garbage on its control sockets unchanged."""

import contextlib
import random
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from fwk.bus.sockets import GROUP, LOOPBACK, multicast_receiver
from fwk.control.address import gateway_address, supervisor_address
from fwk.lcm import wire
from fwk.model.ports import Ports
from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, TICKS, WAITS, until_it_waits
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import difference
from tests.harness.runs import PortBlock, pause, write_files

pytestmark = pytest.mark.system

HOSTS, CHANNELS = 9, 14  # of the orchestra
AT_ONCE = 300  # datagrams between two checks


class Echo:
    """Receives all multicast of a run and sends it back, cut and garbled, to any port, from a port of its own."""

    def __init__(self, ports: Ports, luck: random.Random) -> None:
        shared = [ports.sync, ports.record, ports.log, ports.status]
        shared += [ports.stage(stage) for stage in range(10)]
        shared += [ports.channel(channel) for channel in range(CHANNELS)]
        own = [ports.host(host) for host in range(HOSTS + 1)]
        self.sent = 0
        self._ears = [multicast_receiver(port) for port in shared]
        self._to = [(GROUP, port) for port in shared] + [(LOOPBACK, port) for port in [*own, ports.supervisor]]
        self._luck = luck
        self._heard: list[bytes] = []
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
        self._socket.bind((LOOPBACK, 0))

    def close(self) -> None:
        for each in (*self._ears, self._socket):
            each.close()

    def disturb(self) -> None:
        """Reads the waiting datagrams and sends garbled ones."""
        own = self._socket.getsockname()[1]
        for ears in self._ears:
            with contextlib.suppress(BlockingIOError):
                while True:
                    datagram, address = ears.recvfrom(wire.DATAGRAM_MAX)
                    if address[1] != own and len(self._heard) < 2000:
                        self._heard.append(datagram)
        for _ in range(AT_ONCE if self._heard else 0):
            with contextlib.suppress(OSError):
                self._socket.sendto(self._worse(self._luck.choice(self._heard)), self._luck.choice(self._to))
                self.sent += 1

    def _worse(self, datagram: bytes) -> bytes:
        kind, at = self._luck.randrange(4), self._luck.randrange(len(datagram) + 1)
        if kind == 0:
            return datagram  # unchanged: only its source is wrong
        if kind == 1:
            return datagram[:at]
        if kind == 2:
            return datagram[:at] + self._luck.randbytes(8) + datagram[at + 8 :]
        return self._luck.randbytes(self._luck.randrange(200))


class Caller:
    """Sends garbage to control sockets, keeps some connections open, and never reads."""

    def __init__(self, addresses: list[str], luck: random.Random) -> None:
        self._addresses = addresses
        self._luck = luck
        self._held: list[socket.socket] = []

    def close(self) -> None:
        for each in self._held:
            each.close()

    def disturb(self) -> None:
        words = [
            b"\0" * 100,
            b"[" * 5000 + b"\n",
            b'{"verb"',
            b'{"verb":"status"}\n' * 30,
            b'{"verb":"watch","channel":',
        ]
        for address in self._addresses:
            made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            with contextlib.suppress(OSError):  # not there yet, or enough connections
                made.setblocking(False)
                made.connect(address)
                made.send(self._luck.choice(words) + self._luck.randbytes(20) + self._luck.choice([b"", b"\n"]))
            self._held.append(made)
        while len(self._held) > 20:
            self._held.pop(self._luck.randrange(len(self._held))).close()


@pytest.fixture
def disturbers(ports: PortBlock) -> Iterator[list[Echo | Caller]]:
    luck = random.Random(3)
    sockets = [supervisor_address(ports.bus), gateway_address(ports.bus)]
    made: list[Echo | Caller] = [Echo(Ports(ports.bus, HOSTS, CHANNELS), luck), Caller(sockets, luck)]
    yield made
    for each in made:
        each.close()


def test_garbled_echoes_and_garbage_requests_change_nothing(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, disturbers: list[Echo | Caller]
) -> None:
    run = launch(*RUN, "--ticks", str(TICKS), "--speed", "1", *WAITS)
    until_it_waits(run)
    after.note(run)
    (traced / "go-on").touch()
    while run.process.poll() is None:
        for each in disturbers:
            each.disturb()
        pause(0.05)
    recording = after.check(run, equal_to=undisturbed)
    assert recording.gaps() == {}
    assert "refused" in run.text
    assert "cannot answer" not in run.text
    assert "ended:" not in run.text
    assert disturbers[0].sent > AT_ONCE  # type: ignore[union-attr]


HOSTILE = """
name: hostile
public_url: ""
components:
  c/counter: { use: "counting:Counter" }
  c/follower: { use: "small:Follower", channels: { imu: c/imu } }
  x/hostile: { use: "hostile:Hostile" }
"""


def test_broken_messages_from_a_component_harm_no_other(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, {**sources("counting.py", "small.py", "helper.py", "hostile.py"), "it.yaml": HOSTILE})
    used = Ports(ports.bus, 3, 2)
    sending = ("--set", f"x/hostile.base={used.base}", "--set", f"x/hostile.end={used.end}")
    for log, options in (("quiet.lcm", ()), ("loud.lcm", sending)):
        run = launch("it.yaml", "--ticks", "100", "--speed", "max", "--record", log, *options)
        assert run.wait() == 0, run.text
        assert "Traceback" not in run.text
    assert "refused" in run.text
    assert difference(tmp_path / "quiet.lcm", tmp_path / "loud.lcm") == ""

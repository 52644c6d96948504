"""Garbage, forgeries and foreign messages on every port are refused by name and change nothing."""

import contextlib
import socket
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from socket import AF_INET
from typing import Any, NoReturn

import lcm
import psutil
import pytest

from fwk.bus import sync
from fwk.bus.sockets import GROUP, LOOPBACK, multicast_receiver
from fwk.lcm import wire
from fwk.lcm.messages import type_named
from fwk.model.ports import Ports
from fwk.model.requests import channel_request, lost_message, main_loop_request, plugin_request
from lcmtypes.core import actual_t, done_t, fetch_t, gone_t, log_t, protocol_t, status_t, tick_record_t, tick_t
from tests.harness.fixtures import Launch
from tests.harness.logs import difference
from tests.harness.runs import Launched, PortBlock, pause, played
from tests.programs.orchestra import orchestra

pytestmark = pytest.mark.system

HOSTS, CHANNELS = 9, 14  # of the orchestra
RUN = ("launch/orchestra.yaml", "--ticks", "40", "--seed", "7", "--record", "log.lcm")

UNHURRIED = ("--speed", "1")  # foreign processes that share its processors get time before it ends


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of an undisturbed run."""
    return played(tmp_path_factory.mktemp("reference"), orchestra, *RUN)


class Stranger:
    """Opens a socket that belongs to no process of the run."""

    def __init__(self, address: str = LOOPBACK, port: int = 0) -> None:
        self._socket = socket.socket(AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
        self._socket.bind((address, port))

    def close(self) -> None:
        self._socket.close()

    def send(self, datagram: bytes, port: int, group: str = GROUP) -> None:
        with contextlib.suppress(ConnectionRefusedError):  # of an earlier stranger, to a process that was not there yet
            self._socket.sendto(datagram, (group, port))

    def say(self, channel: str, data: bytes, port: int, group: str = GROUP) -> None:
        for datagram in wire.datagrams(1, channel.encode(), data):
            self.send(datagram, port, group)


@pytest.fixture
def stranger() -> Iterator[Stranger]:
    with contextlib.closing(Stranger()) as made:
        yield made


RUBBISH = [
    b"",
    b"x",
    b"LC02",
    b"LC02\0\0\0\1no end",
    b"LC02\0\0\0\1\0",
    b"LC02\0\0\0\1d/note\0",
    b"LC03\0\0\0\1",
    struct.pack(">4sIIIHH", b"LC03", 1, 2**31, 0, 0, 40_000) + b"d/note\0",
    struct.pack(">4sIIIHH", b"LC03", 2, 255 << 20, 0, 0, 65_000) + b"d/note\0",
    bytes(65_000),
]


def plausible(run: int) -> list[tuple[str, bytes]]:
    """Returns harmful messages for the right ports, whole and cut off; `run` may be the real run number."""
    done, actual, fetch, gone, tick, record = done_t(), actual_t(), fetch_t(), gone_t(), tick_t(), tick_record_t()
    for each in (done, actual, fetch, gone, tick, record):
        each.run = run
    done.host, done.incarnation, done.tick, done.step = 5, 1, 10, 5
    done.n_marks, done.channel, done.sequence = 1, [3], [10**6]
    actual.host, actual.incarnation = 5, 1
    fetch.host, fetch.channel, fetch.last_sequence = 10**6, 7, 10**12
    gone.channel, gone.first_sequence, gone.last_sequence = 7, 1, 10**12
    tick.version, tick.tick, tick.step = protocol_t.VERSION, 10**6, 5
    record.version, record.tick = protocol_t.VERSION, 1
    note: Any = type_named("play.note_t")()
    note.header.sequence, note.header.writer = 3, "d/player"
    whole = [
        ("fwk/done", sync.encode_done(done)),
        ("fwk/actual", actual.encode()),
        ("fwk/fetch", fetch.encode()),
        ("fwk/gone", gone.encode()),
        ("fwk/tick", sync.encode_tick(tick)),
        ("fwk/record", record.encode()),
        ("fwk/log", log_t().encode()),
        ("fwk/status", status_t().encode()),
        ("d/note", note.encode()),
        ("d/note", status_t().encode()),
    ]
    return whole + [(channel, data[:20]) for channel, data in whole]


def all_ports(ports: Ports) -> list[tuple[str, int]]:
    """Returns every address of a run: multicast ports, and ports of one process."""
    shared = [(GROUP, port) for port in (ports.sync, ports.record, ports.log, ports.status)]
    shared += [(GROUP, ports.stage(stage)) for stage in range(10)]
    shared += [(GROUP, ports.channel(channel)) for channel in range(CHANNELS)]
    own = [(LOOPBACK, ports.host(host)) for host in range(HOSTS + 1)]
    return [*shared, *own, (LOOPBACK, ports.supervisor)]


@pytest.fixture
def disguised(ports: PortBlock) -> Iterator[list[Stranger]]:
    """Strangers at all ports of the processes of the run, at another address."""
    with contextlib.ExitStack() as opened:
        members = Ports(ports.bus, HOSTS, CHANNELS).members
        yield [opened.enter_context(contextlib.closing(Stranger("127.0.0.2", port))) for port in members]


class Ears:
    """Listens to ticks, as any process of this machine can; `run` is the run's number once it is known, else 0."""

    def __init__(self, ports: Ports) -> None:
        self.run = 0
        self._supervisor = (LOOPBACK, ports.supervisor)
        self._socket = multicast_receiver(ports.stage(0))
        self._assembler = wire.Assembler()

    def listen(self) -> None:
        with contextlib.suppress(BlockingIOError):
            while not self.run:
                datagram, address = self._socket.recvfrom(wire.DATAGRAM_MAX)
                if address == self._supervisor:
                    _, data = self._assembler.feed(datagram, address[1]) or (b"", b"")
                    self.run = sync.decode_tick(data).run

    def close(self) -> None:
        self._socket.close()


def assert_unharmed(run: Launched, folder: Path, reference: Path) -> None:
    """Asserts that the run ends well, with the messages of an undisturbed run, and without a failed process."""
    assert run.wait() == 0, run.text
    assert difference(reference, folder / "log.lcm") == ""
    assert "Traceback" not in run.text
    assert "ended:" not in run.text


def test_foreign_datagrams_on_inner_ports_change_nothing(
    launch: Launch, folder: Path, ports: PortBlock, reference: Path, stranger: Stranger
) -> None:
    inner = Ports(ports.bus, HOSTS, CHANNELS)
    ears = Ears(inner)
    run = launch(*RUN, *UNHURRIED)
    while run.process.poll() is None:
        ears.listen()
        for group, port in all_ports(inner):
            for datagram in RUBBISH:
                stranger.send(datagram, port, group)
            for channel, data in plausible(ears.run):
                stranger.say(channel, data, port, group)
        pause(0.05)
    ears.close()
    assert_unharmed(run, folder, reference)
    assert ears.run
    assert "refused" in run.text
    assert "times)" in run.text  # counted, not repeated each time
    assert run.text.count("refused") < 1000
    text_log = (run.run_dir / "fwk.log").read_text()  # the console throttles floods
    for port_of in ("fwk/sync", "fwk/tick", "fwk/record", "fwk/log", "fwk/fetch", "d/note"):
        assert f"{port_of}: " in text_log


def requests() -> list[done_t]:
    """Returns dones with requests that the plan does not allow, or that would stop everything."""
    main_loop, plugins, lost, channels = done_t(), done_t(), done_t(), done_t()
    main_loop.main_loop = [main_loop_request(10**6, [77])]
    plugins.plugins = [plugin_request(5, "stop", ["*"])]
    lost.lost = [lost_message(10**6, 1)]
    channels.channels = [channel_request(10**6, ["close", 1])]
    return [main_loop, plugins, lost, channels]


def mean(run: int) -> list[tuple[str, bytes]]:
    """Returns dones, ticks and records that would end or damage a run."""
    made = []
    for asking in (done_t(), *requests()):
        stages = [(done_t.STAGE, step) for step in range(10)]
        for kind, step in [*stages, (done_t.FINAL, -1), (done_t.ITERATION, -1), (9, 0)]:
            asking.run, asking.host, asking.incarnation, asking.tick = run, 5, 1, 10
            asking.kind, asking.step, asking.iteration = kind, step, 1
            asking.channel, asking.sequence = [-1, 10**6], [10**9, 10**9]
            made.append(("fwk/done", sync.encode_done(asking)))
    for stage in range(10):
        tick = tick_t()
        tick.version, tick.run, tick.tick, tick.step = protocol_t.VERSION, run, 10, stage
        tick.channel, tick.sequence = [-1, 3], [10**9, 10**9]
        made.append(("fwk/tick", sync.encode_tick(tick)))
    return made


def test_own_ports_at_another_address_are_foreign(
    launch: Launch, folder: Path, ports: PortBlock, reference: Path, disguised: list[Stranger]
) -> None:
    """All of 127.0.0.0/8 is this machine, so every port is free at another address."""
    inner = Ports(ports.bus, HOSTS, CHANNELS)
    ears = Ears(inner)
    run = launch(*RUN, *UNHURRIED)
    while run.process.poll() is None:
        for stranger in disguised:
            ears.listen()
            for group, port in all_ports(inner):
                for channel, data in plausible(ears.run) + mean(ears.run) * (port == inner.sync):
                    stranger.say(channel, data, port, group)
            pause(0.05)  # the run has to get on beside
    ears.close()
    assert_unharmed(run, folder, reference)
    assert ears.run
    text_log = (run.run_dir / "fwk.log").read_text()  # the console throttles floods
    for port_of in ("fwk/sync", "fwk/tick", "fwk/record", "fwk/log", "fwk/fetch", "d/note"):
        assert f"{port_of}: datagram from 127.0.0.2, port " in text_log


def test_foreign_datagrams_on_the_public_bus_change_nothing(
    launch: Launch, folder: Path, ports: PortBlock, reference: Path, stranger: Stranger
) -> None:
    run = launch(*RUN, *UNHURRIED)
    bus = lcm.LCM(ports.public_url)
    public_port = int(ports.public_url.split(":")[2].split("?")[0])
    while run.process.poll() is None:
        for channel, data in plausible(1):
            bus.publish(channel, data)
        bus.publish("somebody/else", b"12345678")
        for datagram in RUBBISH:
            stranger.send(datagram, public_port)
        pause()
    assert_unharmed(run, folder, reference)
    assert "d/note: another program (port " in run.text
    assert "somebody/else" not in run.text  # other programs may send there
    assert run.text.count("on the public bus") < 100


def test_the_network_is_not_heard_on_inner_ports(ports: PortBlock, leave_out: Callable[[str], NoReturn]) -> None:
    addresses = [each.address for found in psutil.net_if_addrs().values() for each in found if each.family == AF_INET]
    outside = next((address for address in addresses if not address.startswith("127.")), None)
    if not outside:
        leave_out("needs a network interface besides the loopback")
    ears = multicast_receiver(ports.bus)
    with socket.socket(AF_INET, socket.SOCK_DGRAM) as other:
        joined = socket.inet_aton(GROUP) + socket.inet_aton(outside)
        other.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, joined)
        for interface, message in ((outside, b"from the network"), (LOOPBACK, b"from here")):
            other.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
            other.sendto(message, (GROUP, ports.bus))
    assert ears.recv(100) == b"from here"
    ears.close()

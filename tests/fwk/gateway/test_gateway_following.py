"""The gateway follows tick records: contents and order of the recording, its fetches, and the fetches it answers."""

import socket
from collections.abc import Iterator

import pytest

from fwk.bus.network import UdpNetwork
from fwk.bus.sender import Sender
from fwk.bus.sockets import multicast_receiver
from fwk.gateway.gateway import Gateway
from fwk.lcm import wire
from fwk.lcm.messages import sequence_of
from fwk.model.ports import Ports
from lcmtypes.core import fetch_records_t, fetch_t, gone_t, log_t, protocol_t, tick_record_t, void_t
from tests.fwk.host.host_parts import IMU, imu, plan
from tests.harness.datagrams import received
from tests.harness.runs import PortBlock

RUN = 4711


class Kept:
    """A sink that keeps everything."""

    def __init__(self) -> None:
        self.messages: list[tuple[str, bytes]] = []
        self.closed = False

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        self.messages.append((channel, data))

    def tick(self) -> None:
        pass

    def close(self) -> None:
        self.closed = True

    @property
    def sequences(self) -> list[int]:
        return [sequence_of(data) for channel, data in self.messages if channel == IMU]

    @property
    def ticks(self) -> list[int]:
        return [tick_record_t.decode(data).tick for channel, data in self.messages if channel == "fwk/record"]


class Followed:
    """A gateway with its surroundings played by the test: `publish` and `record`, then `serve`."""

    def __init__(self, base: int) -> None:
        made = plan(base)
        self.ports = Ports.of(made)
        self.supervisor, self.writer, self.reader = (
            Sender(port, UdpNetwork()) for port in (self.ports.supervisor, self.ports.host(0), self.ports.host(1))
        )
        self._ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        theirs.setblocking(False)
        self._control = theirs
        self._network = UdpNetwork()
        self.gateway = Gateway(made, RUN, self._network, theirs, None)
        self.kept = Kept()
        self.gateway.sinks.append(self.kept)

    def publish(self, *sequences: int, writer: str = "r/senses") -> None:
        for sequence in sequences:
            self.writer.publish(IMU.encode(), imu(sequence, writer), self.ports.channel(0))

    def record(self, tick: int, mark: int = 0, run: int = RUN, void_above: int | None = None) -> None:
        made = tick_record_t()
        made.version = protocol_t.VERSION
        made.run, made.tick, made.time_us = run, tick, tick * 50_000
        if mark:
            made.n_marks, made.channel, made.sequence = 1, [0], [mark]
        if void_above is not None:
            void = void_t()
            void.channel, void.above_sequence, void.up_to_tick, void.before_incarnation = 0, void_above, tick, 2
            made.n_voids, made.voids = 1, [void]
        self.supervisor.publish(b"fwk/record", made.encode(), self.ports.record)

    def serve(self) -> None:
        """Lets the gateway process everything sent so far, and end."""
        self._ours.close()
        self._network.run(self.gateway.serve())

    def receive(self) -> None:
        """Lets the gateway process the records sent so far."""
        self._network.run(self.gateway._receive_records())

    def ask(self, host: int, first: int, last: int) -> None:
        """Sends a fetch that the writer passes on, in whose place the gateway answers."""
        fetch = fetch_t()
        fetch.run, fetch.host, fetch.channel, fetch.first_sequence, fetch.last_sequence = RUN, host, 0, first, last
        self.writer.send(b"fwk/fetch", fetch.encode(), self.ports.host(self.ports.gateway))

    def close(self) -> None:
        for each in (self.supervisor, self.writer, self.reader):
            each.socket.close()
        for end in (self._ours, self._control):
            end.close()
        self._network.close()


@pytest.fixture
def followed(ports: PortBlock) -> Iterator[Followed]:
    made = Followed(ports.bus)
    yield made
    made.close()


def gone_of(message: tuple[bytes, bytes] | None) -> tuple[int, int]:
    assert message
    assert message[0] == b"fwk/gone"
    gone = gone_t.decode(message[1])
    return gone.first_sequence, gone.last_sequence


def test_recording_holds_exactly_the_messages_of_the_marks(followed: Followed) -> None:
    followed.publish(1, 2, 3)
    followed.record(1, mark=2)
    followed.record(2)
    followed.serve()
    assert [channel for channel, _ in followed.kept.messages] == [IMU, IMU, "fwk/record", "fwk/record"]
    assert followed.kept.sequences == [1, 2]
    assert followed.kept.closed


def test_records_are_taken_in_order_and_once(followed: Followed) -> None:
    followed.publish(1, 2, 3)
    for tick, mark in ((3, 3), (1, 1), (3, 3), (2, 2), (1, 1)):
        followed.record(tick, mark)
    followed.serve()
    assert followed.kept.ticks == [1, 2, 3]
    assert followed.kept.sequences == [1, 2, 3]


def test_a_missing_record_is_fetched(followed: Followed) -> None:
    followed.record(1)
    followed.record(4)
    followed.serve()
    assert followed.kept.ticks == [1]
    message = received(followed.supervisor, followed.ports)
    assert message
    fetch = fetch_records_t.decode(message[1])
    assert (message[0], fetch.first_tick, fetch.last_tick) == (b"fwk/fetch_records", 2, 3)


def test_records_of_another_run_are_refused(followed: Followed) -> None:
    followed.record(1, run=RUN + 1)
    followed.serve()
    assert followed.kept.ticks == []


def test_messages_beyond_a_dead_writers_marks_go_unrecorded(followed: Followed) -> None:
    followed.publish(1, 2)
    followed.publish(2, writer="r/senses#2")
    followed.record(1, mark=2, void_above=1)
    followed.serve()
    writers = [data for channel, data in followed.kept.messages if channel == IMU]
    assert writers == [imu(1), imu(2, "r/senses#2")]


def test_gateway_answers_for_a_dead_writer_with_two_ticks(followed: Followed) -> None:
    followed.publish(1, 2, 3, 4)  # in the ticks with these numbers
    for tick in range(1, 5):
        followed.record(tick, mark=tick)
    followed.receive()
    followed.publish(5)
    ears = multicast_receiver(followed.ports.channel(0))
    followed.ask(host=1, first=1, last=6)
    followed.serve()
    gone = [gone_of(received(followed.reader, followed.ports)) for _ in range(2)]
    assert gone == [(1, 2), (6, 6)]
    came = [wire.Assembler().feed(ears.recv(wire.DATAGRAM_MAX), 0) for _ in range(3)]
    sent = [sequence_of(data) for _, data in filter(None, came)]
    assert sent == [3, 4, 5]
    ears.close()


def test_the_newest_message_of_a_quiet_writer_is_kept(followed: Followed) -> None:
    followed.publish(1)
    for tick in range(1, 9):
        followed.record(tick, mark=1)
    followed.receive()
    followed.ask(host=1, first=1, last=1)
    followed.serve()
    assert received(followed.reader, followed.ports) is None


def test_an_unobtainable_message_is_given_up_and_logged(followed: Followed) -> None:
    followed.publish(2)
    followed.record(1, mark=2)
    followed.ask(host=followed.ports.gateway, first=1, last=1)
    followed.receive()
    followed.serve()
    (line,) = [log_t.decode(data).text for channel, data in followed.kept.messages if channel == "fwk/log"]
    assert followed.kept.sequences == [2]
    assert line == f"{IMU}: 1 messages of 1 to 1 are lost and not in the recording"


def test_a_record_that_the_plan_cannot_have_is_refused(followed: Followed) -> None:
    """The record comes from the supervisor's port; the gateway names it and continues."""
    for damage in (b"", b"x" * 40, tick_record_t().encode()[:30]):
        followed.supervisor.publish(b"fwk/record", damage, followed.ports.record)
    strange = tick_record_t()
    strange.version, strange.run, strange.tick = protocol_t.VERSION, RUN, 1
    strange.n_marks, strange.channel, strange.sequence = 1, [10**6], [1]
    followed.supervisor.publish(b"fwk/record", strange.encode(), followed.ports.record)
    followed.publish(1)
    followed.record(1, mark=1)
    followed.serve()
    assert (followed.kept.ticks, followed.kept.sequences) == ([1], [1])
    said = [log_t.decode(data).text for channel, data in followed.kept.messages if channel == "fwk/log"]
    assert any("fwk/record: " in text and "refused" in text for text in said)

"""Sockets of a channel: order, loss, repetition, restart of the writer, and foreign datagrams."""

from collections.abc import Iterator

import pytest

from fwk.bus.channel_socket import ChannelSocket
from fwk.bus.network import UdpNetwork
from fwk.bus.sender import Sender
from fwk.lcm import wire
from fwk.model.plan import ChannelPlan
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t
from tests.harness.runs import PortBlock

PLAN = ChannelPlan(0, "cyan1/pose", "soccer.pose_t", 0, ())
WRITER, STRANGER = 1, 2
"""Ports, counted from the channel's."""


def pose(sequence: int, writer: str = "cyan1/localization", x_m: float = 0.0, tick: int = 0) -> bytes:
    made = pose_t()
    made.header.sequence, made.header.writer, made.x_m, made.header.tick = sequence, writer, x_m, tick
    return made.encode()


class Wired:
    def __init__(self, port: int) -> None:
        self.port = port
        self.complaints: list[str] = []
        writers = (port + WRITER,)
        self.network = UdpNetwork()
        self.inbox = ChannelSocket(
            PLAN,
            self.network.group_socket(port),
            writers,
            lambda channel, text: self.complaints.append(f"{channel}: {text}"),
        )
        self.sender = Sender(port + WRITER, self.network)

    def _complain(self, channel: str, text: str) -> None:
        self.complaints.append(f"{channel}: {text}")

    def send(self, *sequences: int, writer: str = "cyan1/localization", tick: int = 0) -> None:
        for sequence in sequences:
            self.sender.publish(b"cyan1/pose", pose(sequence, writer, tick=tick), self.port)

    def taken(self) -> list[int]:
        return [pose_t.decode(data).header.sequence for data in self.inbox.take()]


@pytest.fixture
def wired(ports: PortBlock) -> Iterator[Wired]:
    made = Wired(ports.bus)
    yield made
    made.inbox.close()
    made.sender.socket.close()


def test_messages_beyond_the_mark_wait(wired: Wired) -> None:
    wired.send(1, 2, 3)
    wired.inbox.mark = 2
    assert wired.inbox.collect()
    assert wired.taken() == [1, 2]
    wired.inbox.mark = 3
    assert wired.inbox.collect()
    assert wired.taken() == [3]


def test_a_gap_is_noticed_and_filled_by_retransmission(wired: Wired) -> None:
    wired.send(1, 3)
    wired.inbox.mark = 3
    assert not wired.inbox.collect()
    assert wired.inbox.missing() == [2]
    wired.send(2, 3)
    assert wired.inbox.collect()
    assert wired.taken() == [1, 2, 3]


def test_repeated_messages_count_once(wired: Wired) -> None:
    wired.send(1, 1, 2, 1, 2)
    wired.inbox.mark = 2
    assert wired.inbox.collect()
    assert wired.taken() == [1, 2]


def test_unobtainable_messages_are_given_up(wired: Wired) -> None:
    wired.send(3)
    wired.inbox.mark = 3
    assert not wired.inbox.collect()
    assert wired.inbox.give_up(1, 2) == 2
    assert wired.inbox.collect()
    assert wired.taken() == [3]


def test_an_unobtainable_newest_message_delays_nothing(wired: Wired) -> None:
    wired.send(1)
    wired.inbox.mark = 2
    assert not wired.inbox.collect()
    assert wired.inbox.give_up(2, 2) == 1
    assert wired.inbox.collect()
    assert wired.taken() == [1]


def test_a_late_joiner_takes_only_the_newest(wired: Wired) -> None:
    wired.send(56, 57)
    wired.inbox.mark = 57
    wired.inbox.keep_newest()
    assert wired.inbox.collect()
    assert wired.taken() == [57]


@pytest.mark.parametrize("new_first", [False, True])
def test_messages_of_a_dead_writer_beyond_the_marks_are_void(wired: Wired, new_first: bool) -> None:
    wired.send(1)
    writers = ["cyan1/localization", "cyan1/localization#2"]
    for writer in reversed(writers) if new_first else writers:
        wired.send(2, writer=writer)
    wired.inbox.mark = 2
    wired.inbox.void(above=1, up_to_tick=0, before_incarnation=2)
    assert wired.inbox.collect()
    assert [pose_t.decode(data).header.writer for data in wired.inbox.take()] == writers


@pytest.mark.parametrize("void_first", [False, True])
def test_messages_of_other_writers_after_a_death_are_not_void(wired: Wired, void_first: bool) -> None:
    wired.send(1, tick=4)
    wired.send(2, writer="cyan1/dead", tick=5)
    if void_first:
        wired.inbox.void(above=1, up_to_tick=5, before_incarnation=2)
    wired.send(2, writer="cyan1/heir", tick=6)
    wired.inbox.void(above=1, up_to_tick=5, before_incarnation=2)
    wired.inbox.mark = 2
    assert wired.inbox.collect()
    assert [pose_t.decode(data).header.writer for data in wired.inbox.take()] == ["cyan1/localization", "cyan1/heir"]


def test_a_dead_writers_message_alone_is_forgotten(wired: Wired) -> None:
    wired.send(1, 2)
    wired.inbox.void(above=1, up_to_tick=0, before_incarnation=2)
    wired.inbox.mark = 2
    assert not wired.inbox.collect()
    assert wired.inbox.missing() == [2]


def stranger(data: bytes, channel: bytes = b"cyan1/pose") -> bytes:
    return wire.datagrams(1, channel, data)[0]


@pytest.mark.parametrize(
    ("port", "datagram", "says"),
    [
        (STRANGER, stranger(pose(2)), "port {}, which is not the writer's"),
        (WRITER, b"rubbish", "not an LCM message"),
        (WRITER, stranger(pose(2))[:30], "not a soccer.pose_t"),
        (WRITER, stranger(imu_t().encode() + bytes(50)), "not a soccer.pose_t"),
        (WRITER, stranger(pose(2), b"cyan1/other"), "channel 'cyan1/other'"),
    ],
)
def test_foreign_datagrams_are_refused_and_named(wired: Wired, port: int, datagram: bytes, says: str) -> None:
    wired.send(1)
    other = wired.sender if port == WRITER else Sender(wired.port + port, wired.network)
    other.socket.sendto(datagram, ("239.255.76.67", wired.port))
    if other is not wired.sender:
        other.socket.close()
    wired.inbox.mark = 2
    assert not wired.inbox.collect()
    assert says.format(wired.port + port) in wired.complaints[0]
    wired.send(2)
    assert wired.inbox.collect()
    assert wired.taken() == [1, 2]


def test_large_messages_come_in_fragments(wired: Wired) -> None:
    data = pose(1) + bytes(200_000)
    wired.sender.publish(b"cyan1/pose", data, wired.port)
    wired.inbox.mark = 1
    assert wired.inbox.collect()
    assert wired.inbox.take() == [data]

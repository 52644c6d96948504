"""LCM's wire format: liblcm and fwk read each other's messages, and hostile datagrams are refused."""

import os
import struct
import threading
from collections.abc import Iterator

import lcm
import pytest

from fwk.bus.public import PublicBus
from fwk.lcm import wire
from fwk.lcm.messages import MessageError
from fwk.model.public_url import UrlError, parse_url
from tests.harness.runs import PortBlock

SIZES = [0, 1, 300, 65_000, 65_490, 65_499, 65_500, 131_000, 1_000_000]


@pytest.fixture
def url(ports: PortBlock) -> str:
    return ports.public_url


@pytest.fixture
def ours(url: str) -> Iterator[PublicBus]:
    made = PublicBus(url)
    yield made
    made.close()


@pytest.mark.parametrize("size", SIZES)
def test_a_message_survives_its_datagrams_in_any_order(size: int) -> None:
    data = os.urandom(size)
    assembler = wire.Assembler()
    parts = wire.datagrams(7, b"cyan1/odometry", data)
    assert all(len(part) <= 65_507 for part in parts)
    got = [message for part in reversed(parts) if (message := assembler.feed(part, 1))]
    assert got == [(b"cyan1/odometry", data)]


@pytest.mark.parametrize("size", SIZES[1:])
def test_liblcm_reads_datagrams_of_fwk(url: str, ours: PublicBus, size: int) -> None:
    real, got = lcm.LCM(url), []
    real.subscribe("ch/one", lambda channel, data: got.append((channel, data))).set_queue_capacity(0)
    data = os.urandom(size)
    ours.publish("ch/one", data)
    real.handle_timeout(5000)
    assert got == [("ch/one", data)]


@pytest.mark.parametrize("size", SIZES[1:])
def test_fwk_reads_datagrams_of_liblcm(url: str, ours: PublicBus, size: int) -> None:
    real, data = lcm.LCM(url), os.urandom(size)
    sender = threading.Thread(target=real.publish, args=("ch/one", data))
    sender.start()
    sender.join()
    message = ours.receive()
    while message and message[0] != "ch/one":  # liblcm's self test
        message = ours.receive()
    assert message
    assert message[:2] == ("ch/one", data)


def test_the_public_bus_does_not_hear_itself(url: str, ours: PublicBus) -> None:
    other = PublicBus(url)
    ours.publish("a", b"1")
    other.publish("a", b"2")
    heard = ours.receive()
    assert heard
    assert heard[1] == b"2"
    assert ours.receive() is None
    other.close()


LONG = struct.Struct(">4sIIIHH")


@pytest.mark.parametrize(
    "datagram",
    [
        b"",
        b"LC0",
        b"LC02\0\0\0\1no end of the name",
        b"XXXX\0\0\0\1a\0b",
        b"LC03\0\0\0\1",
        LONG.pack(b"LC03", 1, 100, 0, 5, 5) + b"part beyond count",
        LONG.pack(b"LC03", 1, 100, 0, 0, 60000) + b"a\0b",
        LONG.pack(b"LC03", 1, 2**31, 0, 0, 40000) + b"a\0b",
        LONG.pack(b"LC03", 1, 70000, 69999, 1, 2) + b"does not fit",
        LONG.pack(b"LC03", 1, 70000, 0, 0, 2) + b"no name",
    ],
)
def test_a_hostile_datagram_is_refused_by_name(datagram: bytes) -> None:
    with pytest.raises(MessageError):
        wire.Assembler().feed(datagram, 1)


def test_unfinished_messages_do_not_pile_up() -> None:
    assembler = wire.Assembler()
    for number in range(1000):
        assembler.feed(wire.datagrams(number, b"a", bytes(70_000))[0], 1)
    assert len(assembler._unfinished) <= 64


@pytest.mark.parametrize(
    "url", ["tcpq://localhost", "udpm://127.0.0.1:7667", "udpm://239.0.0.1:7667?ttl=x", "udpm://239.0.0.1:x"]
)
def test_a_url_of_another_kind_is_refused_with_an_example(url: str) -> None:
    with pytest.raises(UrlError, match=r"udpm://239\.255\.76\.67:7667"):
        parse_url(url)

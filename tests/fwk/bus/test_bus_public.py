"""The public bus knows whether a program can hear it."""

import socket
from collections.abc import Iterator

import pytest

from fwk.bus import listeners
from fwk.bus.public import PublicBus
from tests.harness.runs import PortBlock, pause

NOW_US = 1_000_000


@pytest.fixture
def bus(ports: PortBlock, monkeypatch: pytest.MonkeyPatch) -> Iterator[PublicBus]:
    """A bus that looks for listeners only once by itself, as its wall time stands still."""
    monkeypatch.setattr(listeners, "monotonic_us", lambda: NOW_US)
    made = PublicBus(ports.public_url)
    yield made
    made.close()


def test_a_program_that_sends_is_a_listener_at_once(bus: PublicBus, ports: PortBlock) -> None:
    assert bus.busy_listeners() is None
    other = PublicBus(ports.public_url)
    assert bus.busy_listeners() is None
    other.publish("wish", b"1")
    for _ in range(500):
        if bus.receive():
            break
        pause(0.01)
    assert bus.busy_listeners() is not None
    other.close()


def test_opening_the_bus_sends_nothing(ports: PortBlock) -> None:
    group, _, port = ports.public_url.removeprefix("udpm://").partition("?")[0].partition(":")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as java:
        java.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        java.bind((group, int(port)))
        opened = PublicBus(ports.public_url)  # joins the group, also for the other socket
        again = PublicBus(ports.public_url)
        again.publish("wish", b"1")
        java.settimeout(5.0)
        assert b"wish" in java.recv(1000), "the first datagram"
        opened.close()
        again.close()


def test_a_socket_of_ipv6_can_listen_too(bus: PublicBus, ports: PortBlock) -> None:
    port = int(ports.public_url.partition("?")[0].rpartition(":")[2])
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as java:
        java.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        java.bind(("::", port))
        assert bus.busy_listeners() is not None

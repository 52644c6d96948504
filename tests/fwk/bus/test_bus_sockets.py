"""Consecutive senders on one port, as those of a restarted host."""

from fwk.bus.network import UdpNetwork
from fwk.bus.sender import Sender
from fwk.bus.sockets import multicast_receiver
from fwk.lcm import wire
from tests.harness.runs import PortBlock


def test_halves_of_two_incarnations_are_not_joined(ports: PortBlock) -> None:
    ears, assembler = multicast_receiver(ports.bus), wire.Assembler()
    for life, kept in ((b"1", 0), (b"2", 1)):  # the beginning of the first and the end of the second
        sender = Sender(ports.bus + 1, UdpNetwork())
        sender.publish(b"a/large", life * 100_000, ports.bus)
        sender.socket.close()
        halves = [ears.recv(wire.DATAGRAM_MAX) for _ in range(2)]
        assert assembler.feed(halves[kept], ports.bus + 1) is None
    ears.close()

"""Messages that a host sends, and sends again, on dynamic channels."""

from collections.abc import Iterator

import pytest

from fwk.bus.sender import Sender
from fwk.host.outputs import Outputs
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t
from tests.fwk.host.host_parts import imu, plan
from tests.harness.runs import PortBlock

CHANNEL, INDEX = "r/spot", 1
ASKS = 1  # host


class Sent(Sender):
    """Notes datagrams and their ports instead of sending them."""

    def __init__(self) -> None:
        self.messages: list[tuple[bytes, bytes, int]] = []

    def publish(self, channel: bytes, data: bytes, port: int) -> None:
        self.messages.append((channel, data, port))

    def send(self, channel: bytes, data: bytes, port: int) -> None:
        self.messages.append((channel, data, port))

    def publish_paced(self, channel: bytes, data: bytes, port: int) -> None:
        self.messages.append((channel, data, port))


@pytest.fixture
def ports() -> Iterator[Ports]:
    block = PortBlock()
    yield Ports.of(plan(block.bus))
    block.release()


def fetch(first: int, last: int) -> fetch_t:
    made = fetch_t()
    made.host, made.channel, made.first_sequence, made.last_sequence = ASKS, INDEX, first, last
    return made


def passed_on(sent: Sent, ports: Ports) -> list[tuple[int, int]]:
    """Returns the ranges that were requested from the gateway."""
    asked = [fetch_t.decode(data) for name, data, port in sent.messages if port == ports.host(ports.gateway)]
    return [(each.first_sequence, each.last_sequence) for each in asked]


def test_messages_of_other_writers_come_from_the_gateway(ports: Ports) -> None:
    sent = Sent()
    outputs = Outputs({}, ports, sent, {}, {}, lambda: 0)
    outputs.open(INDEX, CHANNEL)
    outputs.publish([(CHANNEL, imu(3)), (CHANNEL, imu(4))])
    outputs.open(INDEX, CHANNEL)  # closed, written by another component up to 6, and opened again
    outputs.publish([(CHANNEL, imu(7))])
    sent.messages.clear()
    outputs.answer(fetch(1, 8))
    again = [data for name, data, port in sent.messages if port == ports.channel(INDEX)]
    assert again == [imu(3), imu(4), imu(7)]
    assert passed_on(sent, ports) == [(1, 2), (5, 6), (8, 8)]


def test_gateway_answers_for_the_channels_of_a_predecessor(ports: Ports) -> None:
    sent = Sent()
    Outputs({}, ports, sent, {}, {}, lambda: 0).answer(fetch(2, 3))
    assert passed_on(sent, ports) == [(2, 3)]
    assert len(sent.messages) == 1

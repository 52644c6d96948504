"""Messages of other programs on channels that a plan opens to them: acceptance, stamps, and limits."""

import socket
from collections.abc import Iterator

import pytest

from fwk import Component, Reads
from fwk.bus.network import UdpNetwork
from fwk.bus.public import PublicBus
from fwk.bus.sender import Sender
from fwk.gateway.gateway import Gateway
from fwk.gateway.ingress import BYTES_MAX, WAITING_MAX
from fwk.lcm import messages
from fwk.lcm.messages import Header
from fwk.model.ports import Ports
from fwk.recording.sinks import Mirror
from fwk.testing.plans import plan_of
from lcmtypes.core import log_t, protocol_t, tick_record_t
from lcmtypes.robot import imu_t, motor_command_t
from tests.fwk.gateway.test_gateway_following import RUN, Kept
from tests.harness.runs import PortBlock

WISH = "r/wish"


class Obeys(Component):
    stage = "think"
    wish: Reads[motor_command_t]
    shared: Reads[imu_t]


class Opened:
    """A gateway on a separate public bus, another program there, and a main loop played by the test."""

    def __init__(self, ports: PortBlock) -> None:
        outside = {WISH: "robot.motor_command_t", "r/shared": "robot.imu_t"}
        made = plan_of({"r/obeys": Obeys}, outside=outside, bus_port=ports.bus, public_url=ports.public_url)
        self.channel = next(channel.index for channel in made.channels if channel.name == WISH)
        self.ports = Ports.of(made)
        self.other = PublicBus(ports.public_url)
        self._ours, self._theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._theirs.setblocking(False)
        self._supervisor = Sender(self.ports.supervisor, UdpNetwork())
        self._bus = PublicBus(ports.public_url)
        self._network = UdpNetwork()
        self.gateway = Gateway(made, RUN, self._network, self._theirs, self._bus)
        self.kept = Kept()
        self.gateway.sinks += [self.kept, Mirror(made, self._bus, self.gateway.publisher)]

    def say(self, data: bytes, channel: str = WISH) -> None:
        self.other.publish(channel, data)

    def record(self, tick: int, mark: int) -> None:
        made = tick_record_t()
        made.version = protocol_t.VERSION
        made.run, made.tick, made.time_us = RUN, tick, tick * 50_000
        made.n_marks, made.channel, made.sequence = 1, [self.channel], [mark]
        self._supervisor.publish(b"fwk/record", made.encode(), self.ports.record)

    def hear(self) -> None:
        while self.gateway._hear_outside():
            pass

    def follow(self) -> None:
        self._network.run(self.gateway._receive_records())
        self.gateway.publisher.send_due()

    @property
    def wishes(self) -> list[bytes]:
        return [data for channel, data in self.kept.messages if channel == WISH]

    @property
    def said(self) -> list[str]:
        return [log_t.decode(data).text for channel, data in self.kept.messages if channel == "fwk/log"]

    def close(self) -> None:
        self._ours.close()
        self._network.run(self.gateway.serve())
        for each in (self._supervisor.socket, self.other, self._bus, self._theirs):
            each.close()
        self._network.close()


@pytest.fixture
def opened(ports: PortBlock) -> Iterator[Opened]:
    made = Opened(ports)
    yield made
    made.close()


def wish(vx_m_s: float = 0.0) -> bytes:
    made = motor_command_t()
    made.vx_m_s = vx_m_s
    made.header.tick, made.header.sequence, made.header.writer = 99, 99, "somebody"
    return made.encode()


def test_a_message_is_stamped_and_recorded_when_a_mark_names_it(opened: Opened) -> None:
    opened.record(1, 0)
    opened.follow()
    for speed in (1.0, 2.0):
        opened.say(wish(speed))
    opened.hear()
    assert opened.gateway._ingress.marks == {opened.channel: 2}
    assert opened.wishes == []
    opened.record(2, 1)
    opened.follow()
    opened.record(3, 2)
    opened.follow()
    headers = [Header.of(data) for data in opened.wishes]
    assert [(header.tick, header.stage, header.sequence, header.writer) for header in headers] == [
        (2, -1, 1, "outside"),
        (2, -1, 2, "outside"),
    ]
    assert [messages.decode(motor_command_t, data, WISH).vx_m_s for data in opened.wishes] == [1.0, 2.0]
    assert opened.gateway._ingress.marks == {}
    assert opened.said == []


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (imu_t().encode(), "not a robot.motor_command_t: fingerprint"),
        (wish()[:-1], "bytes do not decode"),
        (wish() + b"x", "1 bytes more than a robot.motor_command_t"),
        (wish() + bytes(BYTES_MAX), f"a message from outside has at most {BYTES_MAX}"),
        (b"", "not a robot.motor_command_t"),
    ],
)
def test_message_of_another_type_is_refused_with_its_sender(opened: Opened, data: bytes, reason: str) -> None:
    opened.say(data)
    opened.hear()
    assert opened.gateway._ingress.marks == {}
    (line,) = opened.said
    port = opened.other._sender.getsockname()[1]
    assert line.startswith(f"{WISH}: from port {port} on the public bus: ")
    assert reason in line
    assert line.endswith("; refused")


def test_flood_is_bounded_and_reported_until_the_next_tick(opened: Opened) -> None:
    for number in range(WAITING_MAX + 30):
        opened.say(wish(float(number)))
        opened.hear()
    assert opened.gateway._ingress.marks == {opened.channel: WAITING_MAX}
    first, tenth = opened.said
    assert f"{WAITING_MAX} messages wait for the next tick already" in first
    assert tenth.endswith("(10 times)")
    opened.record(1, WAITING_MAX)
    opened.follow()
    opened.say(wish())
    opened.hear()
    assert opened.gateway._ingress.marks == {opened.channel: WAITING_MAX + 1}


def test_one_read_of_the_public_bus_ends_under_any_load(opened: Opened) -> None:
    for _ in range(600):
        opened.other.publish("somebody/else", b"12345678")
    assert opened.gateway._hear_outside()


def test_closed_channels_and_framework_channels_are_refused(opened: Opened) -> None:
    opened.say(wish(), "fwk/record")
    opened.say(wish(), "somebody/else")
    opened.hear()
    (line,) = opened.said
    assert line.startswith("fwk/record: another program (port ")


def test_messages_from_the_public_bus_are_not_echoed(opened: Opened) -> None:
    opened.say(wish(1.0))
    opened.hear()
    opened.record(1, 1)
    opened.follow()
    opened.hear()
    assert len(opened.wishes) == 1
    heard = []
    while message := opened.other.receive():
        heard.append(message[0])
    assert "fwk/record" in heard
    assert WISH not in heard
    assert opened.said == []

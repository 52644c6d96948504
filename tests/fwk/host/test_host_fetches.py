"""Fetches of a reader whose answers are lost: how often it asks the writer, and when the gateway."""

from dataclasses import replace
from typing import Literal

import pytest

from fwk.bus.memory_network import MemoryNetwork
from fwk.bus.sender import Sender
from fwk.bus.sockets import GROUP, Address
from fwk.host.inputs import WRITER_TIMEOUT_US, Inputs
from fwk.lcm import wire
from fwk.model.ports import Ports
from tests.fwk.host.host_parts import IMU, imu, plan

WRITER, READER = 0, 1

Clock = Literal["simulated", "wall"]


class Waiting:
    """A reader that lacks the first message of a channel, on a network that brings no answer by itself."""

    def __init__(self, clock: Clock) -> None:
        made = replace(plan(7700), clock=clock)
        self.ports = Ports.of(made)
        self.asked: list[int] = []
        """Ports to which fetches were sent."""
        self.network = MemoryNetwork(self._take)
        sender = Sender(self.ports.host(READER), self.network)
        inputs = Inputs(made, made.channels, [], READER, 1, self.network, sender, lambda *_: None)
        lacking = inputs.collect(inputs.advance([0], [1], []))
        self._steps = inputs.fetch(lacking, lambda: True)
        self._until_us = next(self._steps)

    def _take(self, _datagram: bytes, address: Address) -> None:
        self.asked.append(address[1])

    def wait(self, duration_us: int) -> None:
        """Lets this much time pass."""
        end_us = self.network.clock_us + duration_us
        while self._until_us <= end_us:
            self._until_us = self.network.run_once(self._steps, self._until_us)
        self.network.clock_us = end_us

    def arrive(self) -> None:
        """Brings the message."""
        datagram = wire.in_one(1, IMU.encode(), imu(1))
        self.network.put(datagram, (GROUP, self.ports.channel(0)), self.ports.host(WRITER))
        self.network.run(self._steps, self._until_us)


def test_in_real_time_a_writer_is_asked_often_before_the_gateway() -> None:
    reader = Waiting("wall")
    reader.wait(WRITER_TIMEOUT_US)
    writer, gateway = reader.ports.host(WRITER), reader.ports.host(reader.ports.gateway)
    asked = reader.asked.index(gateway)
    assert asked >= 25  # if every second fetch or its answer is lost, one reader in 30 million gets none
    assert set(reader.asked[:asked]) == {writer}
    assert set(reader.asked[asked:]) == {gateway}


def test_in_lockstep_only_the_writer_is_asked() -> None:
    reader = Waiting("simulated")
    reader.wait(20 * WRITER_TIMEOUT_US)
    assert set(reader.asked) == {reader.ports.host(WRITER)}
    assert len(reader.asked) < 120


@pytest.mark.parametrize("clock", ["wall", "simulated"])
def test_a_late_answer_ends_the_fetches(clock: Clock) -> None:
    reader = Waiting(clock)
    reader.wait(100_000)
    with pytest.raises(StopIteration) as ended:
        reader.arrive()
    assert ended.value.value is True

"""Inputs and outputs of a host without its process: waits, fetches, answers, and losses."""

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest

from fwk.bus import sockets
from fwk.bus.channel_socket import ChannelSocket
from fwk.bus.network import UdpNetwork
from fwk.bus.sender import Sender
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.message_history import MESSAGES_MAX
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.lcm.messages import sequence_of
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t, void_t
from tests.fwk.host.host_parts import IMU, imu, plan
from tests.harness.datagrams import received
from tests.harness.runs import PortBlock, pause

RUN = 4711


class Pair:
    """Writer's and reader's ends of one channel in this process; `weather` decides which datagrams arrive."""

    def __init__(self, base: int, together: bool = False, before: int = 0, restarted: bool = False) -> None:
        made = plan(base, together)
        self.ports = Ports.of(made)
        channel = made.channels[0]
        reader_host = made.components[1].host
        self.network = UdpNetwork()
        self.writer_socket = Sender(self.ports.host(0), self.network)
        self.reader_socket = self.writer_socket if together else Sender(self.ports.host(reader_host), self.network)
        self.gateway_socket = Sender(self.ports.host(self.ports.gateway), self.network)
        self.network.watch(self.reader_socket.socket)
        self.complaints: list[str] = []
        self.inputs = Inputs(
            made,
            [channel],
            [channel] if together else [],
            reader_host,
            RUN,
            self.network,
            self.reader_socket,
            lambda name, text: self.complaints.append(f"{name}: {text}"),
            restarted=restarted,
        )
        self.outputs = Outputs(
            {IMU: channel}, self.ports, self.writer_socket, self.inputs.local, {IMU: before}, self.network.now_us
        )
        self.asked: list[fetch_t] = []

    def close(self) -> None:
        self.inputs.close()
        for each in {self.writer_socket, self.reader_socket, self.gateway_socket}:
            each.socket.close()

    def serve(self) -> bool:
        """Lets the writer answer and the reader take the answer."""
        for end in (self.writer_socket, self.reader_socket):
            while message := received(end, self.ports):
                if message[0] == b"fwk/fetch":
                    self.asked.append(fetch_t.decode(message[1]))
                    self.outputs.answer(fetch_t.decode(message[1]))
                else:
                    self.inputs.gone(gone_t.decode(message[1]))
        return len(self.asked) < 20

    def wait(self, moved: Sequence[ChannelBuffer], serve: Callable[[], bool]) -> bool:
        """Waits until all visible messages of `moved` have arrived, or `serve` returns False."""
        return self.network.run(self.inputs.fetch(self.inputs.collect(moved), serve))

    def take(self, mark: int) -> list[int]:
        """Returns the sequence numbers that a reader gets when the mark is `mark`."""
        moved = self.inputs.advance([0], [mark], [])
        assert self.wait(moved, self.serve)
        return [sequence_of(data) for box in moved for data in box.take()]


Make = Callable[..., Pair]


@pytest.fixture
def make(ports: PortBlock) -> Iterator[Make]:
    made: list[Pair] = []

    def kept(**how: Any) -> Pair:
        made.append(Pair(ports.bus, **how))
        return made[-1]

    yield kept
    for each in made:
        each.close()


def test_exactly_the_marked_messages_are_waited_for_and_given(make: Make) -> None:
    pair = make()
    assert pair.outputs.publish([(IMU, imu(1)), (IMU, imu(2)), (IMU, imu(3))]) == {0: 3}
    assert pair.take(2) == [1, 2]
    assert pair.take(3) == [3]
    assert pair.asked == []


def test_lost_messages_are_fetched(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    pair = make()
    with monkeypatch.context() as storm:
        storm.setattr(pair.writer_socket, "publish", lambda *_: None)
        pair.outputs.publish([(IMU, imu(1)), (IMU, imu(2))])
    pair.outputs.publish([(IMU, imu(3))])
    assert pair.take(3) == [1, 2, 3]
    assert [(fetch.first_sequence, fetch.last_sequence) for fetch in pair.asked[:1]] == [(1, 2)]
    assert pair.inputs.fetched == 2
    assert pair.inputs.lost == 0


def test_messages_that_are_gone_are_counted_as_lost(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    pair = make()
    with monkeypatch.context() as storm:
        storm.setattr(pair.writer_socket, "publish", lambda *_: None)
        pair.outputs.publish([(IMU, imu(number)) for number in range(1, MESSAGES_MAX + 11)])  # a tick each
    assert pair.take(MESSAGES_MAX + 10) == list(range(11, MESSAGES_MAX + 11))
    assert pair.inputs.lost == 10


def test_large_message_passes_a_buffer_of_one_fragment(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sockets.multicast_receiver, "__defaults__", (1,))
    pair = make()
    large = imu(1) + bytes(1_000_000)
    pair.outputs.publish([(IMU, large)])
    moved = pair.inputs.advance([0], [1], [])

    def write_again() -> None:
        for _ in range(100):
            pause(0.004)
            pair.serve()
            pair.writer_socket.send_due()

    helper = threading.Thread(target=write_again)
    helper.start()
    assert pair.wait(moved, lambda: True)
    helper.join()
    assert moved[0].take() == [large]


def test_a_stop_request_ends_a_wait(make: Make) -> None:
    pair = make()
    moved = pair.inputs.advance([0], [1], [])
    assert not pair.wait(moved, lambda: False)


def test_a_reader_in_the_same_process_needs_no_socket(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    pair = make(together=True)
    monkeypatch.setattr(pair.writer_socket, "publish", lambda *_: None)
    pair.outputs.publish([(IMU, imu(1))])
    assert not isinstance(pair.inputs.local[IMU], ChannelSocket)
    assert pair.take(1) == [1]


def test_a_newcomer_takes_the_newest_visible_message(make: Make) -> None:
    pair = make()
    pair.outputs.publish([(IMU, imu(number)) for number in (1, 2, 3)])
    moved = pair.inputs.advance([0], [3], [])
    pair.inputs.keep_newest()
    assert pair.wait(moved, pair.serve)
    assert [sequence_of(data) for data in moved[0].take()] == [3]


def test_only_messages_of_a_predecessor_come_from_the_gateway(make: Make) -> None:
    pair = make(before=5)
    pair.outputs.publish([(IMU, imu(6)), (IMU, imu(7))])
    fetch = fetch_t()
    fetch.run, fetch.host, fetch.channel, fetch.first_sequence, fetch.last_sequence = RUN, 1, 0, 4, 7
    pair.outputs.answer(fetch)
    message = received(pair.gateway_socket, pair.ports)
    assert message
    passed = fetch_t.decode(message[1])
    assert (passed.host, passed.first_sequence, passed.last_sequence) == (1, 4, 5)
    assert received(pair.gateway_socket, pair.ports) is None


def test_restarted_process_fetches_its_own_past_from_the_gateway(make: Make) -> None:
    pair = make(together=True, before=5, restarted=True)
    moved = pair.inputs.advance([0], [5], [])
    pair.inputs.keep_newest()
    pair.gateway_socket.publish(IMU.encode(), imu(5), pair.ports.channel(0))
    assert pair.wait(moved, pair.serve)
    assert [sequence_of(data) for data in moved[0].take()] == [5]
    pair.inputs.forget_predecessor()
    pair.outputs.publish([(IMU, imu(6, "r/senses#2"))])
    assert pair.take(6) == [6]


def test_unfinished_messages_of_a_dead_writer_are_dropped(make: Make) -> None:
    pair = make()
    pair.outputs.publish([(IMU, imu(1)), (IMU, imu(2))])  # the done for message 2 never came
    void = void_t()
    void.channel, void.above_sequence, void.up_to_tick, void.before_incarnation = 0, 1, 2, 2
    moved = pair.inputs.advance([0], [1], [void])
    assert pair.wait(moved, pair.serve)
    assert [sequence_of(data) for data in moved[0].take()] == [1]
    successor = imu(2, "r/senses#2")
    pair.outputs.publish([(IMU, successor)])
    moved = pair.inputs.advance([0], [2], [])
    assert pair.wait(moved, pair.serve)
    assert moved[0].take() == [successor]


def test_a_gone_answer_does_not_drop_messages_that_are_here(make: Make) -> None:
    pair = make()
    pair.outputs.publish([(IMU, imu(1)), (IMU, imu(2))])
    moved = pair.inputs.advance([0], [2], [])
    gone = gone_t()
    gone.run, gone.channel, gone.first_sequence, gone.last_sequence = RUN, 0, 1, 2
    assert pair.inputs.gone(gone) == 0
    assert pair.wait(moved, pair.serve)
    assert [sequence_of(data) for data in moved[0].take()] == [1, 2]


def test_a_foreign_process_cannot_fetch_or_answer(make: Make) -> None:
    pair = make()
    stranger = Sender(pair.ports.end + 1, pair.network)
    stranger.send(b"fwk/gone", gone_t().encode(), pair.ports.host(1))
    said: list[str] = []
    assert received(pair.reader_socket, pair.ports, lambda _, text: said.append(text)) is None
    assert said == [f"datagram from port {pair.ports.end + 1}, which is not of this run; refused"]
    stranger.socket.close()

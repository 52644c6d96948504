"""eCAL: publishers and subscribers over its shared memory, connected by its own registration."""

import struct
from typing import Any

import ecal.nanobind_core as ecal
from lcmtypes.bench import sample_t

from tools.bench.peers.inbox import Answers, Inbox
from tools.bench.shape import Shape
from tools.bench.timing import sleep_s

_NUMBERS = struct.Struct("=ii")


def supervisor(shape: Shape) -> "EcalSupervisor":
    """The supervisor's side."""
    return EcalSupervisor(shape)


def component(shape: Shape, index: int) -> "EcalComponent":
    """A component's side."""
    return EcalComponent(shape, index)


def _subscriber(topic: str, handler: Any) -> Any:
    made = ecal.Subscriber(topic)
    made.set_receive_callback(handler)
    return made


class EcalSupervisor:
    """A topic for the ticks of each stage, one for dones."""

    def __init__(self, shape: Shape) -> None:
        ecal.initialize("bench supervisor")
        self._answers = Answers()
        self._dones = [_subscriber(f"done{index}", self._on_done) for index in range(shape.components)]
        self._ticks = [ecal.Publisher(f"tick{stage}") for stage in range(shape.stages)]

    def _on_done(self, _publisher: Any, _type: Any, received: Any) -> None:
        self._answers.put(*_NUMBERS.unpack(bytes(received.buffer)))

    def begin(self, stage: int, tick: int) -> None:
        self._ticks[stage].send(_NUMBERS.pack(stage, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        return self._answers.take(timeout_s)

    def close(self) -> None:
        sleep_s(0.2)  # the last ticks are on their way
        ecal.finalize()


class EcalComponent:
    """Callbacks come from threads of eCAL."""

    def __init__(self, shape: Shape, index: int) -> None:
        ecal.initialize(f"bench c{index}")
        self._index = index
        self._inbox: Inbox[bytes] = Inbox(shape.sources(index))
        self._data = ecal.Publisher(f"data{index}")
        self._dones = ecal.Publisher(f"done{index}")
        self._subscribers = [_subscriber(f"data{source}", self._handler(source)) for source in shape.sources(index)]
        self._subscribers.append(_subscriber(f"tick{shape.stage(index)}", self._on_tick))

    def _handler(self, source: int) -> Any:
        return lambda _publisher, _type, received: self._inbox.put(source, bytes(received.buffer))

    def _on_tick(self, _publisher: Any, _type: Any, received: Any) -> None:
        self._inbox.put_tick(_NUMBERS.unpack(bytes(received.buffer))[1])

    def tick(self) -> int:
        return self._inbox.tick()

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        return [sample_t.decode(data) if data is not None else None for data in self._inbox.newest()]

    def publish(self, sample: sample_t) -> None:
        self._data.send(sample.encode())

    def done(self, tick: int) -> None:
        self._dones.send(_NUMBERS.pack(self._index, tick))

    def close(self) -> None:
        ecal.finalize()

"""ZeroMQ over ipc: PUB and SUB for ticks and data, PUSH and PULL for dones."""

import struct
from contextlib import suppress

import zmq
from lcmtypes.bench import sample_t

from tools.bench.shape import Shape

_NUMBERS = struct.Struct("=ii")


def supervisor(shape: Shape) -> "ZmqSupervisor":
    """The supervisor's side."""
    return ZmqSupervisor(shape)


def component(shape: Shape, index: int) -> "ZmqComponent":
    """A component's side."""
    return ZmqComponent(shape, index)


def _address(shape: Shape, name: str) -> str:
    return f"ipc://{shape.folder}/{name}"


class ZmqSupervisor:
    """One PUB socket for each stage, so that no component receives ticks of other stages."""

    def __init__(self, shape: Shape) -> None:
        self._context = zmq.Context()
        self._ticks = []
        for stage in range(shape.stages):
            self._ticks.append(self._context.socket(zmq.PUB))
            self._ticks[-1].bind(_address(shape, f"tick{stage}"))
        self._dones = self._context.socket(zmq.PULL)
        self._dones.bind(_address(shape, "dones"))

    def begin(self, stage: int, tick: int) -> None:
        self._ticks[stage].send(_NUMBERS.pack(stage, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        if not self._dones.poll(int(timeout_s * 1000)):
            return None
        index, tick = _NUMBERS.unpack(self._dones.recv())
        return index, tick

    def close(self) -> None:
        self._context.destroy(linger=500)


class ZmqComponent:
    """One SUB socket for ticks, one connected to all sources; the newest data are kept."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._index = index
        self._context = zmq.Context()
        self._ticks = self._socket(zmq.SUB)
        self._ticks.setsockopt(zmq.SUBSCRIBE, b"")
        self._ticks.connect(_address(shape, f"tick{shape.stage(index)}"))
        self._dones = self._socket(zmq.PUSH)
        self._dones.connect(_address(shape, "dones"))
        self._data = self._socket(zmq.PUB)
        self._data.bind(_address(shape, f"data{index}"))
        self._inputs = self._socket(zmq.SUB)
        self._inputs.setsockopt(zmq.SUBSCRIBE, b"")
        self._newest: dict[int, sample_t | None] = dict.fromkeys(shape.sources(index))
        for source in shape.sources(index):
            self._inputs.connect(_address(shape, f"data{source}"))

    def _socket(self, kind: int) -> "zmq.Socket[bytes]":
        return self._context.socket(kind)

    def tick(self) -> int:
        tick: int = _NUMBERS.unpack(self._ticks.recv())[1]
        return tick

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        raw = {}
        with suppress(zmq.Again):
            while True:
                source, data = self._inputs.recv_multipart(zmq.NOBLOCK)
                raw[int(source)] = data
        for number, data in raw.items():
            self._newest[number] = sample_t.decode(data)
        return list(self._newest.values())

    def publish(self, sample: sample_t) -> None:
        self._data.send_multipart([b"%d" % self._index, sample.encode()])

    def done(self, tick: int) -> None:
        self._dones.send(_NUMBERS.pack(self._index, tick))

    def close(self) -> None:
        self._context.destroy(linger=500)

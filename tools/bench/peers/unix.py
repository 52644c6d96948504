"""Unix datagram sockets: the minimum for separate processes; a message is sent once to each of its readers."""

import select
import socket
import struct

from lcmtypes.bench import sample_t

from tools.bench.shape import Shape

_NUMBERS = struct.Struct("=ii")
_BUFFER_BYTES = 4 << 20
_DATA_MAX = 1 << 20


def supervisor(shape: Shape) -> "UnixSupervisor":
    """The supervisor\'s side."""
    return UnixSupervisor(shape)


def component(shape: Shape, index: int) -> "UnixComponent":
    """A component\'s side."""
    return UnixComponent(shape, index)


def _bound(path: str) -> socket.socket:
    made = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _BUFFER_BYTES)
    made.bind(path)
    return made


class UnixSupervisor:
    """Sends a tick to each component of a stage."""

    def __init__(self, shape: Shape) -> None:
        self._shape = shape
        self._socket = _bound(f"{shape.folder}/supervisor")
        self._paths = [[f"{shape.folder}/tick{index}" for index in shape.members(s)] for s in range(shape.stages)]

    def begin(self, stage: int, tick: int) -> None:
        message = _NUMBERS.pack(stage, tick)
        for path in self._paths[stage]:
            try:
                self._socket.sendto(message, path)
            except (FileNotFoundError, ConnectionRefusedError):  # not started yet, or ended
                continue

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        self._socket.settimeout(timeout_s)
        try:
            index, tick = _NUMBERS.unpack(self._socket.recv(64))
        except TimeoutError:
            return None
        return index, tick

    def close(self) -> None:
        self._socket.close()


class UnixComponent:
    """One socket for ticks, one for each source."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._index = index
        self._supervisor = f"{shape.folder}/supervisor"
        made = [_bound(f"{shape.folder}/data{source}-{index}") for source in shape.sources(index)]
        self._inputs = {source.fileno(): source for source in made}
        self._newest: dict[int, sample_t | None] = dict.fromkeys(self._inputs)
        self._ready = select.poll()
        for number in self._inputs:
            self._ready.register(number, select.POLLIN)
        self._readers = [f"{shape.folder}/data{index}-{reader}" for reader in shape.readers(index)]
        self._ticks = _bound(f"{shape.folder}/tick{index}")

    def tick(self) -> int:
        tick: int = _NUMBERS.unpack(self._ticks.recv(64))[1]
        return tick

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        raw: dict[int, bytes] = {}
        while ready := self._ready.poll(0):
            for number, _ in ready:
                raw[number] = self._inputs[number].recv(_DATA_MAX)
        for number, data in raw.items():
            self._newest[number] = sample_t.decode(data)
        return list(self._newest.values())

    def publish(self, sample: sample_t) -> None:
        data = sample.encode()
        for path in self._readers:
            try:
                self._ticks.sendto(data, path)
            except (FileNotFoundError, ConnectionRefusedError):  # not started yet, or ended
                continue

    def done(self, tick: int) -> None:
        self._ticks.sendto(_NUMBERS.pack(self._index, tick), self._supervisor)

    def close(self) -> None:
        for made in (self._ticks, *self._inputs.values()):
            made.close()

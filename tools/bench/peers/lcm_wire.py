"""LCM's wire format on plain multicast sockets, a port a channel, data drained at the tick; no contract.

fwk's inner buses work the same way. The difference to the peer `lcm` is the cost of liblcm's reader threads, the
difference to fwk the cost of the contract.
"""

import select
import socket
import struct

from lcmtypes.bench import sample_t

from tools.bench.shape import Shape

_NUMBERS = struct.Struct(">ii")
_SHORT = struct.Struct(">4sI")  # magic, number
_LONG = struct.Struct(">4sIIIHH")  # magic, number, size, offset, number and count of fragments
_SHORT_MAX, _FRAGMENT = 65_499, 65_487
_DATAGRAM_MAX = 65_535
_GROUP, _LOOPBACK = "239.255.76.67", "127.0.0.1"
_BUFFER_BYTES = 4 << 20


def supervisor(shape: Shape) -> "WireSupervisor":
    """The supervisor's side."""
    return WireSupervisor(shape)


def component(shape: Shape, index: int) -> "WireComponent":
    """A component's side."""
    return WireComponent(shape, index)


class _Ports:
    def __init__(self, shape: Shape) -> None:
        self.dones = shape.base_port
        self._ticks = shape.base_port + 1
        self._data = self._ticks + shape.stages

    def tick(self, stage: int) -> int:
        return self._ticks + stage

    def data(self, component: int) -> int:
        return self._data + component


def _receiver(port: int) -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER_BYTES)
    made.bind((_GROUP, port))
    made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(_GROUP) + socket.inet_aton(_LOOPBACK))
    return made


class _Sender:
    def __init__(self) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(_LOOPBACK))
        self._number = 0

    def publish(self, channel: bytes, data: bytes, port: int) -> None:
        self._number += 1
        body = channel + b"\0" + data
        if len(body) <= _SHORT_MAX:
            self._socket.sendto(_SHORT.pack(b"LC02", self._number) + body, (_GROUP, port))
            return
        name = len(channel) + 1  # the first fragment carries the channel, offsets count data only
        count = -(-len(body) // _FRAGMENT)
        for part in range(count):
            offset = max(0, part * _FRAGMENT - name)
            header = _LONG.pack(b"LC03", self._number, len(data), offset, part, count)
            self._socket.sendto(header + body[part * _FRAGMENT : (part + 1) * _FRAGMENT], (_GROUP, port))


def _body(datagram: bytes) -> bytes:
    return datagram[datagram.index(b"\0", _SHORT.size) + 1 :]


class WireSupervisor:
    """One datagram reaches a whole stage."""

    def __init__(self, shape: Shape) -> None:
        self._ports = _Ports(shape)
        self._sender = _Sender()
        self._dones = _receiver(self._ports.dones)

    def begin(self, stage: int, tick: int) -> None:
        self._sender.publish(b"TICK%d" % stage, _NUMBERS.pack(stage, tick), self._ports.tick(stage))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        self._dones.settimeout(timeout_s)
        try:
            index, tick = _NUMBERS.unpack(_body(self._dones.recv(_DATAGRAM_MAX)))
        except TimeoutError:
            return None
        return index, tick

    def close(self) -> None:
        self._dones.close()


class WireComponent:
    """Waits in the kernel for its tick alone; data stays there until then."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._ports = _Ports(shape)
        self._index = index
        self._own = b"DATA%d" % index
        self._sender = _Sender()
        self._ticks = _receiver(self._ports.tick(shape.stage(index)))
        self._inputs = {(made := _receiver(self._ports.data(source))).fileno(): made for source in shape.sources(index)}
        self._fragments: dict[int, bytes] = {}
        self._newest: dict[int, sample_t | None] = dict.fromkeys(self._inputs)
        self._ready = select.poll()
        for number in self._inputs:
            self._ready.register(number, select.POLLIN)

    def tick(self) -> int:
        tick: int = _NUMBERS.unpack(_body(self._ticks.recv(_DATAGRAM_MAX)))[1]
        return tick

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        raw: dict[int, bytes] = {}
        while ready := self._ready.poll(0):
            for number, _ in ready:
                data = self._message(number, self._inputs[number].recv(_DATAGRAM_MAX))
                if data:
                    raw[number] = data
        for number, data in raw.items():
            self._newest[number] = sample_t.decode(data)
        return list(self._newest.values())

    def _message(self, number: int, datagram: bytes) -> bytes:
        """Returns the data that a datagram completes; empty if fragments are missing."""
        if datagram.startswith(b"LC02"):
            return _body(datagram)
        _, _, size, offset, part, _ = _LONG.unpack_from(datagram)
        body = datagram[_LONG.size :]
        if part == 0:
            self._fragments[number] = body[body.index(b"\0") + 1 :]
        elif len(self._fragments.get(number, b"")) == offset:
            self._fragments[number] += body
        return self._fragments.pop(number) if len(self._fragments.get(number, b"")) == size else b""

    def publish(self, sample: sample_t) -> None:
        self._sender.publish(self._own, sample.encode(), self._ports.data(self._index))

    def done(self, tick: int) -> None:
        self._sender.publish(b"DONE", _NUMBERS.pack(self._index, tick), self._ports.dones)

    def close(self) -> None:
        for source in self._inputs.values():
            source.close()

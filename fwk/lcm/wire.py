"""LCM's udp multicast wire format: messages to datagrams and back."""

import struct

from fwk.lcm.messages import MessageError

_SHORT = struct.Struct(">4sI")  # magic, number of the message on this sender
_LONG = struct.Struct(">4sIIIHH")  # magic, number, size of the data, offset, number and count of fragments
_SHORT_MAGIC, _LONG_MAGIC = b"LC02", b"LC03"
_SHORT_MAX = 65_499  # channel, its zero byte and data of a message that goes in one datagram
_FRAGMENT = 65_487
_MESSAGE_MAX = 256 << 20
_UNFINISHED_MAX = 64  # fragmented messages under way at the same time
_UNFINISHED_BYTES_MAX = 2 * _MESSAGE_MAX  # bytes of all of them; the oldest are dropped first

DATAGRAM_MAX = 65_535
SURELY_SHORT = 65_000
"""A message with less data goes in one datagram, whatever its channel is called."""


def datagrams(number: int, channel: bytes, data: bytes) -> list[bytes]:
    """Returns the datagrams of a message.

    Raises:
        MessageError: the message is larger than LCM's 256 MiB or the channel name longer than 63 bytes.
    """
    if len(channel) > 63 or len(data) > _MESSAGE_MAX:
        raise MessageError(f"{channel.decode()}: a channel has at most 63 bytes, a message at most {_MESSAGE_MAX}")
    size = len(channel) + 1 + len(data)
    if size <= _SHORT_MAX:
        return [in_one(number, channel, data)]
    count = -(-size // _FRAGMENT)
    first = _FRAGMENT - len(channel) - 1
    made = [b"%b%b\0%b" % (_LONG.pack(_LONG_MAGIC, number, len(data), 0, 0, count), channel, data[:first])]
    for part in range(1, count):
        offset = first + (part - 1) * _FRAGMENT
        header = _LONG.pack(_LONG_MAGIC, number, len(data), offset, part, count)
        made.append(header + data[offset : offset + _FRAGMENT])
    return made


def in_one(number: int, channel: bytes, data: bytes) -> bytes:
    """Returns a message as one datagram of any size, for receivers in the same process."""
    return b"".join((_SHORT.pack(_SHORT_MAGIC, number), channel, b"\0", data))


def is_short(datagram: bytes) -> bool:
    """Returns whether a datagram looks like a whole message."""
    return datagram.startswith(_SHORT_MAGIC)


class _Unfinished:
    def __init__(self, size: int, count: int) -> None:
        self.size = size
        self.count = count
        self.channel = b""
        self.bytes = 0
        self._bodies: dict[int, tuple[int, bytes]] = {}

    def add(self, part: int, offset: int, body: bytes) -> bool:
        """Takes a fragment; returns whether it was the last. Memory grows with the fragments, not in advance."""
        if part not in self._bodies:
            self._bodies[part] = offset, body
            self.bytes += len(body)
        return len(self._bodies) == self.count

    def data(self) -> bytes:
        """Returns the whole message.

        Raises:
            MessageError: the fragments are not adjacent.
        """
        bodies, expected = [], 0
        for _, (offset, body) in sorted(self._bodies.items()):
            if offset != expected:
                raise MessageError(f"fragment at {offset} of a message of {self.size} bytes where {expected} is next")
            bodies.append(body)
            expected += len(body)
        if expected != self.size:
            raise MessageError(f"{expected} bytes in all fragments of a message of {self.size}")
        return b"".join(bodies)


class Assembler:
    """Puts messages together from the datagrams of one socket; a message that lacks a fragment is never completed."""

    def __init__(self) -> None:
        self._unfinished: dict[tuple[int, int], _Unfinished] = {}
        self._bytes = 0  # in all of them

    def feed(self, datagram: bytes, source_port: int) -> tuple[bytes, bytes] | None:
        """Takes a datagram; returns (channel, data) if it completes a message.

        Raises:
            MessageError: the datagram does not have LCM's format.
        """
        magic = datagram[:4]
        if magic == _SHORT_MAGIC:
            end = datagram.find(b"\0", 8)
            if end < 0:
                raise MessageError(f"truncated datagram of {len(datagram)} bytes: no channel name")
            return datagram[8:end], datagram[end + 1 :]
        if magic == _LONG_MAGIC and len(datagram) >= _LONG.size:
            return self._fragment(datagram, source_port)
        raise MessageError(f"datagram of {len(datagram)} bytes that is not an LCM message")

    def _fragment(self, datagram: bytes, source_port: int) -> tuple[bytes, bytes] | None:
        _, number, size, offset, part, count = _LONG.unpack_from(datagram)
        body = datagram[_LONG.size :]
        if size > _MESSAGE_MAX or part >= count or count > size // 1000 + 2:
            raise MessageError(f"fragment {part} of {count} of a message of {size} bytes: impossible")
        key = (source_port, number)
        message = self._unfinished.get(key) or _Unfinished(size, count)
        channel = message.channel
        if part == 0:
            end = body.find(b"\0")
            if end < 0:
                raise MessageError("first fragment without a channel name")
            channel, body = body[:end], body[end + 1 :]
        if (message.size, message.count) != (size, count) or offset + len(body) > size:
            raise MessageError(f"fragment at {offset} of {len(body)} bytes does not fit into a message of {size}")
        message.channel = channel
        self._unfinished[key] = message
        before = message.bytes
        complete = message.add(part, offset, body)
        self._bytes += message.bytes - before
        if complete:
            self._forget(key)
            return message.channel, message.data()
        while len(self._unfinished) > _UNFINISHED_MAX or self._bytes > _UNFINISHED_BYTES_MAX:
            self._forget(next(iter(self._unfinished)))
        return None

    def _forget(self, key: tuple[int, int]) -> None:
        self._bytes -= self._unfinished.pop(key).bytes

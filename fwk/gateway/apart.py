"""Takes envelopes apart for those outside a run: a stamp of our own, then the bytes of the device's type alone."""

import struct
from collections.abc import Set

from fwk import messages
from fwk.envelope import STAMP
from fwk.gateway.gateway import Sink
from fwk.messages import Header
from fwk.plan.model import Plan
from lcmtypes.core import stamp_t

_FINGERPRINT = messages.fingerprint(stamp_t)


class Apart:
    """A sink that gets, in place of each envelope on one of these channels, a stamp and the plain message."""

    def __init__(self, sink: Sink, channels: Set[str]) -> None:
        self._sink = sink
        self._begins = {channel: _beginning(channel) for channel in channels}
        self.tick = sink.tick
        self.close = sink.close

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Passes a message on."""
        begin = self._begins.get(channel)
        if begin is not None:
            end = Header.of(data).end
            self._sink.message(STAMP, begin + data[8:end], time_us)
            data = data[end:]
        self._sink.message(channel, data, time_us)


def plain_channels(plan: Plan) -> frozenset[str]:
    """The channels of a plan whose types have no header of ours."""
    types = {channel.name: messages.type_named(channel.type_name) for channel in plan.channels}
    return frozenset(name for name, kind in types.items() if not messages.has_header(kind))


def apart(sink: Sink, channels: Set[str]) -> Sink:
    """The sink itself if there is nothing to take apart."""
    return Apart(sink, channels) if channels else sink


def _beginning(channel: str) -> bytes:
    """Of an encoded `stamp_t`: everything before the members of its header."""
    name = channel.encode() + b"\0"
    return _FINGERPRINT + struct.pack(">I", len(name)) + name

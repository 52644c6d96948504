"""Replaces envelopes by a stamp and the plain message, for recordings and the public bus."""

import struct
from collections.abc import Set
from functools import cache

from fwk.gateway.connections import Sink
from fwk.lcm import envelope, messages
from fwk.lcm.envelope import STAMP
from fwk.lcm.messages import Header
from fwk.model.plan import Plan
from lcmtypes.core import stamp_t

_FINGERPRINT = messages.fingerprint(stamp_t)


class Unwrap:
    """Sink that gives another sink a stamp and the plain message for each envelope.

    Args:
        sink: takes the messages.
        channels: channels of the plan that carry envelopes.
        dynamic: dynamic channels that carry envelopes at the moment.
    """

    def __init__(self, sink: Sink, channels: Set[str], dynamic: Set[str] = frozenset()) -> None:
        self._sink = sink
        self._channels = channels
        self._dynamic = dynamic
        self.tick = sink.tick
        self.close = sink.close

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Passes a message on."""
        if channel in self._channels or channel in self._dynamic:
            end = Header.of(data).end
            self._sink.message(STAMP, _beginning(channel) + data[8:end], time_us)
            data = data[end:]
        self._sink.message(channel, data, time_us)


def plain_channels(plan: Plan) -> frozenset[str]:
    """Returns the channels of a plan whose types have no header."""
    return frozenset(channel.name for channel in plan.channels if envelope.is_plain(channel.type_name))


@cache
def _beginning(channel: str) -> bytes:
    """Returns the bytes of an encoded `stamp_t` before the members of its header."""
    name = channel.encode() + b"\0"
    return _FINGERPRINT + struct.pack(">I", len(name)) + name

"""Envelopes for messages of types without the header: inside a run a header precedes their bytes.

The public bus and recordings carry exactly the bytes of the type. For a type with the header the functions here return
its ordinary codec.
"""

import struct
from collections.abc import Callable
from functools import cache
from typing import Any

from fwk.lcm import messages
from fwk.lcm.messages import Header, Message

STAMP = "fwk/stamp"
"""Channel of the stamps that precede messages without the header outside a run."""
_MARK = int.from_bytes(b"envelope", "big")
_NUMBERS = struct.Struct(">qqqhI")  # as in an encoded header_t: tick, sequence, time_us, stage, length of the writer

Stamped = Callable[[Any, int, int, int, int, str], bytes]
"""Takes a message, tick, sequence number, time in us, stage and writer; returns the bytes inside a run."""


def marked(fingerprint: bytes) -> bytes:
    """Returns the fingerprint of an envelope from that of its content, and vice versa."""
    return (int.from_bytes(fingerprint, "big") ^ _MARK).to_bytes(8, "big")


def fingerprint(message_type: type[Message]) -> bytes:
    """Returns the first eight bytes of the messages of a type inside a run."""
    own = messages.fingerprint(message_type)
    return own if messages.has_header(message_type) else marked(own)


@cache
def is_plain(type_name: str) -> bool:
    """Returns whether messages of a type travel in an envelope."""
    return not messages.has_header(messages.type_named(type_name))


def mistake_in(message_type: type[Message]) -> str:
    """Returns why a type cannot have a channel; empty if it can. Parts of the framework's own messages cannot."""
    name = messages.type_name(message_type)
    if name.startswith("core.") and not messages.has_header(message_type):
        return f"{name} belongs to the framework and does not begin with 'core.header_t header;'"
    return ""


def wrapped(plain: bytes, tick: int, sequence: int, time_us: int, stage: int, writer: str) -> bytes:
    """Returns the envelope of a message; its header is where types with a header have theirs."""
    name = writer.encode() + b"\0"
    return marked(plain[:8]) + _NUMBERS.pack(tick, sequence, time_us, stage, len(name)) + name + plain


def content(data: bytes) -> bytes:
    """Returns the message in an envelope.

    Raises:
        MessageError: the bytes end before the header does.
    """
    return data[Header.of(data).end :]


def decode(message_type: type[Message], data: bytes, channel: str) -> Any:
    """Decodes a message as it travels inside a run.

    Raises:
        MessageError: wrong type or broken bytes.
    """
    return decoder(message_type, channel)(data)


def decoder(message_type: type[Message], channel: str) -> Callable[[bytes], Any]:
    """Returns the function that decodes messages of a channel."""
    decode = messages.decoder(message_type, channel)
    return decode if messages.has_header(message_type) else lambda data: decode(content(data))


def stamper(message_type: type[Message], channel: str) -> Stamped:
    """Returns a function that stamps and encodes messages of a channel that no component writes."""
    encode = messages.encoder(message_type, channel)

    def in_header(message: Any, tick: int, sequence: int, time_us: int, stage: int, writer: str) -> bytes:
        header = message.header
        header.tick, header.sequence, header.time_us, header.stage, header.writer = (
            tick,
            sequence,
            time_us,
            stage,
            writer,
        )
        return encode(message)

    def in_envelope(message: Any, tick: int, sequence: int, time_us: int, stage: int, writer: str) -> bytes:
        return wrapped(encode(message), tick, sequence, time_us, stage, writer)

    return in_header if messages.has_header(message_type) else in_envelope

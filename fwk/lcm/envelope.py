"""Messages of LCM types without our header: inside a run they travel in an envelope, header first, then their bytes.

Outside, on the public bus and in recordings, stand exactly the type's own bytes. A type that has the header needs none
of this: for it the functions here give its usual codec, chosen once a channel.
"""

import struct
from collections.abc import Callable
from functools import cache
from typing import Any

from fwk.lcm import messages
from fwk.lcm.messages import Header, Message

STAMP = "fwk/stamp"
"""Channel of the stamps that outside a run go before messages without our header."""
_MARK = int.from_bytes(b"envelope", "big")
_NUMBERS = struct.Struct(">qqqhI")  # as in an encoded header_t: tick, sequence, time_us, stage, length of the writer

Stamped = Callable[[Any, int, int, int, int, str], bytes]
"""Takes a message, tick, sequence, time_us, stage and writer; makes what travels inside a run."""


def marked(fingerprint: bytes) -> bytes:
    """What an envelope begins with, of its content's fingerprint; and the other way round."""
    return (int.from_bytes(fingerprint, "big") ^ _MARK).to_bytes(8, "big")


def fingerprint(message_type: type[Message]) -> bytes:
    """What messages of this type begin with inside a run."""
    own = messages.fingerprint(message_type)
    return own if messages.has_header(message_type) else marked(own)


@cache
def is_plain(type_name: str) -> bool:
    """Whether messages of a type travel in an envelope."""
    return not messages.has_header(messages.type_named(type_name))


def mistake_in(message_type: type[Message]) -> str:
    """Returns why a type cannot have a channel; empty if it can. Parts of the framework's own messages cannot."""
    name = messages.type_name(message_type)
    if name.startswith("core.") and not messages.has_header(message_type):
        return f"{name} is the framework's own and does not begin with 'core.header_t header;'"
    return ""


def wrapped(plain: bytes, tick: int, sequence: int, time_us: int, stage: int, writer: str) -> bytes:
    """The envelope of a message: where a type with our header has its header, there is this one, too."""
    name = writer.encode() + b"\0"
    return marked(plain[:8]) + _NUMBERS.pack(tick, sequence, time_us, stage, len(name)) + name + plain


def content(data: bytes) -> bytes:
    """What is in an envelope.

    Raises:
        MessageError: the bytes end before the header does.
    """
    return data[Header.of(data).end :]


def decode(message_type: type[Message], data: bytes, channel: str) -> Any:
    """Decodes what travels inside a run.

    Raises:
        MessageError: wrong type or broken bytes.
    """
    return decoder(message_type, channel)(data)


def decoder(message_type: type[Message], channel: str) -> Callable[[bytes], Any]:
    """`decode` for the messages of a channel."""
    decode = messages.decoder(message_type, channel)
    return decode if messages.has_header(message_type) else lambda data: decode(content(data))


def stamper(message_type: type[Message], channel: str) -> Stamped:
    """What stamps and encodes the messages of a channel that no component writes."""
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

"""Encoders and decoders of LCM types as generated straight-line Python: the bytes of lcm-gen in half the time.

They are generated from the description of the members that lcm-gen writes into each class. Types with members of rare
shapes (arrays of several dimensions whose sizes vary, a struct within itself) are left to the code of lcm-gen.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

from fwk.lcm.decoder_source import DecoderSource
from fwk.lcm.encoder_source import EncoderSource
from fwk.lcm.generated_source import RareShapeError

Encoder = Callable[[Any], bytes]
Decoder = Callable[[bytes], Any]


@cache
def encoder(message_type: type[Any]) -> Encoder | None:
    """Returns a function that sets the counts of a message and encodes it; None for a rare shape.

    The function raises various exceptions for members with wrong values.
    """
    try:
        made: Encoder = EncoderSource(message_type).compiled("encode")
        return made
    except RareShapeError:
        return None


@cache
def decoder(message_type: type[Any]) -> Decoder | None:
    """Returns a function that decodes bytes; None for a rare shape.

    The function raises `ValueError` or `struct.error` for bytes that are not a message of the type.
    """
    try:
        made: Decoder = DecoderSource(message_type).compiled("decode")
        return made
    except RareShapeError:
        return None

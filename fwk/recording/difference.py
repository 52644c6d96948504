"""Describes how two recorded messages differ: type, field and both values, or the byte."""

import struct
from dataclasses import dataclass, replace
from typing import Any, Literal

from fwk.lcm import messages
from fwk.lcm.envelope import marked
from fwk.lcm.messages import Header
from fwk.lcm.type_registry import decoded, header_of, in_envelope, types_of

_LAST = 1 << 63  # sorts messages without a header after all others


@dataclass(frozen=True)
class Difference:
    """The first difference of two logs."""

    kind: Literal["value", "type", "missing", "order"]
    channel: str
    tick: int | None
    """None, as stage: the message has no header."""
    stage: int | None
    sequence: int
    """In the header; without one the position of the message on its channel, from 1."""
    writer: str
    path: str
    """Field, such as `ball.covariance[1][0]`, or `byte 57` if no field shows it; empty if a message is missing."""
    values: tuple[str, str]
    """In the first and in the second log."""
    names: tuple[str, str] = ("A", "B")

    def __str__(self) -> str:
        at = f"tick {self.tick}, stage {self.stage}, message {self.sequence}" if self.tick is not None else ""
        where = f"{self.channel}: {at or f'message {self.sequence}, which has no header'}"
        by = f" by {self.writer}" if self.writer else ""
        first, second = (f"{value} in {name}" for value, name in zip(self.values, self.names, strict=True))
        return f"{where}{by}: {f'{self.path} is ' if self.path else ''}{first}, {second}"

    @property
    def key(self) -> tuple[int, int, str, int]:
        """Key that orders differences by tick, stage, channel and sequence number."""
        return _LAST if self.tick is None else self.tick, self.stage or 0, self.channel, self.sequence

    def found_later(self) -> "Difference":
        """Returns this difference for a missing message that was found later in the log."""
        values = tuple("later" if value == "missing" else "here" for value in self.values)
        return replace(self, kind="order", values=(values[0], values[1]))


def missing(channel: str, data: bytes, place: int, lacking: int, reason: str = "missing") -> Difference:
    """Returns the difference that a message is missing in the log of index `lacking`."""
    values = ("there", reason) if lacking else (reason, "there")
    return _difference("missing", channel, data, place, "", values)


def changed(channel: str, a: bytes, b: bytes, place: int) -> Difference:
    """Returns the difference of two messages in the same place."""
    kinds = [" or ".join(messages.type_name(kind) for kind in types_of(data)) for data in (a, b)]
    if a[:8] == marked(b[:8]):
        stamped_first = in_envelope(a)
        stands = ("there", "missing") if stamped_first else ("missing", "there")
        return _difference("type", channel, a if stamped_first else b, place, "its stamp", stands)
    if a[:8] != b[:8]:
        named = [kind or f"unknown (fingerprint {data[:8].hex()})" for kind, data in zip(kinds, (a, b), strict=True)]
        return _difference("type", channel, a, place, "type", (named[0], named[1]))
    path, *values = _field(a, b) or _byte(a, b)
    return _difference("value", channel, min(a, b, key=_tick), place, path, (values[0], values[1]))


def _difference(
    kind: Literal["value", "type", "missing"],
    channel: str,
    data: bytes,
    place: int,
    path: str,
    values: tuple[str, str],
) -> Difference:
    head = header_of(data)
    if head is None:
        return Difference(kind, channel, None, None, place, "", path, values)
    return Difference(kind, channel, head.tick, head.stage, head.sequence, head.writer, path, values)


def _tick(data: bytes) -> tuple[int, int]:
    head = header_of(data)
    return (head.tick, head.stage) if head else (_LAST, 0)


def _field(a: bytes, b: bytes) -> tuple[str, str, str] | None:
    try:
        stamps = [Header.of(data) for data in (a, b)] if in_envelope(a) else []
        return _stamps(*stamps) or _first(decoded(a), decoded(b), "")
    except Exception:  # unknown type, or any error of generated code on broken bytes
        return None


def _stamps(*stamps: Header) -> tuple[str, str, str] | None:
    """Returns how the headers of two envelopes differ, as if they belonged to the messages."""
    for name in ("tick", "sequence", "time_us", "stage", "writer") if stamps else ():
        values = [repr(getattr(stamp, name)) for stamp in stamps]
        if values[0] != values[1]:
            return f"header.{name}", values[0], values[1]
    return None


def _first(a: Any, b: Any, path: str) -> tuple[str, str, str] | None:
    if hasattr(a, "__typenames__"):
        inner = ((getattr(a, name), getattr(b, name), f"{path}.{name}".lstrip(".")) for name in a.__slots__)
    elif isinstance(a, (list, tuple)):
        if len(a) != len(b):
            return f"length of {path}", str(len(a)), str(len(b))
        inner = ((x, y, f"{path}[{index}]") for index, (x, y) in enumerate(zip(a, b, strict=True)))
    else:
        return None if _same(a, b) else (path, repr(a), repr(b))
    return next((found for found in (_first(*item) for item in inner) if found), None)


def _same(a: Any, b: Any) -> bool:
    """Returns whether two values have the same bits: NaN equals NaN, and -0.0 differs from 0.0."""
    if isinstance(a, float):
        return struct.pack(">d", a) == struct.pack(">d", b)
    return bool(a == b)


def _byte(a: bytes, b: bytes) -> tuple[str, str, str]:
    place = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    shown = [f"0x{data[place]:02x}" if place < len(data) else f"the end after {len(data)} bytes" for data in (a, b)]
    return f"byte {place}", shown[0], shown[1]

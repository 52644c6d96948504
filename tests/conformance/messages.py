"""Fills messages of any LCM type with a value for each kind of field."""

import math
import sys
from typing import Any

from fwk.lcm.messages import Message, type_named

_INTEGER_BITS = {"byte": 8, "int8_t": 8, "int16_t": 16, "int32_t": 32, "int64_t": 64}
_PACKAGE = "lcmtypes."
_HEADER = "core.header_t"


class Filling:
    """Values for the fields of a message: a number, a length of lists, and texts that differ from each other."""

    def __init__(self, number: float, text: str = "", length: int = 0, truth: bool = False) -> None:
        self._number = number
        self._text = text
        self._length = length
        self._truth = truth
        self._texts = 0

    def message(self, message_type: type[Message]) -> Any:
        """Returns a message of the type with all fields set, except the header, which belongs to the framework."""
        made: Any = message_type()
        types: Any = message_type
        counts = {name for dimensions in types.__dimensions__ for name in dimensions or () if isinstance(name, str)}
        for name, typename, dimensions in zip(types.__slots__, types.__typenames__, types.__dimensions__, strict=True):
            kind = typename.removeprefix(_PACKAGE)
            if kind == _HEADER:
                continue
            setattr(made, name, self._length if name in counts else self._values(kind, list(dimensions or ())))
        return made

    def _values(self, kind: str, dimensions: list[int | str]) -> Any:
        if not dimensions:
            return self._value(kind)
        length = self._length if isinstance(dimensions[0], str) else dimensions[0]
        if kind == "byte" and len(dimensions) == 1:
            return bytes([self._value(kind)] * length)
        return [self._values(kind, dimensions[1:]) for _ in range(length)]

    def _value(self, kind: str) -> Any:
        if kind == "string":
            self._texts += 1
            return f"{self._text}{self._texts}" if self._text else ""
        if kind == "boolean":
            return self._truth
        if kind in ("float", "double"):
            return self._number
        if kind in _INTEGER_BITS:
            bits = _INTEGER_BITS[kind]
            least, most = (0, 2**bits - 1) if kind == "byte" else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
            if math.isnan(self._number):
                return most
            return least if self._number <= least else most if self._number >= most else round(self._number)
        return self.message(type_named(kind))


def usual() -> Filling:
    """Returns plausible values."""
    return Filling(0.5, "usual", 1, truth=True)


def extremes() -> list[Filling]:
    """Returns values at the limits of their types, and others that are far from plausible."""
    return [
        Filling(0.0),
        Filling(1.0, "cyan1", 3, truth=True),
        Filling(1e9, "x" * 300, 12, truth=True),
        Filling(-1e9, "-", 12),
        Filling(1e100, "\N{GREEK SMALL LETTER ALPHA}", 1, truth=True),
        Filling(-1e100, " ", 1),
        Filling(1e300, "\N{GREEK SMALL LETTER ALPHA}", 1, truth=True),
        Filling(-1e300, " ", 1),
        Filling(1e-300, "0", 2, truth=True),
        Filling(sys.float_info.max, "m", 1, truth=True),
        Filling(math.inf, "infinite", 1, truth=True),
        Filling(-math.inf, "infinite", 1),
        Filling(math.nan, "none", 1, truth=True),
    ]

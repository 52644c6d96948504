"""The source of a decoder of an LCM type."""

import math
import struct
from typing import Any

from fwk.lcm.generated_source import (
    CODES,
    COUNT_BYTES,
    DECODED,
    Dimensions,
    Member,
    Source,
    check_fixed,
    split_at_run,
    type_named,
)

_TOGETHER_MOST = 36
"""Numbers of the largest array of fixed size that is unpacked together with its neighbours: a 6 x 6 matrix."""


class DecoderSource(Source):
    """Source of `decode`, the function for one type.

    Raises:
        RareShapeError: the type has a member of a rare shape.
    """

    def __init__(self, message_type: type[Any]) -> None:
        super().__init__("def decode(data):")
        self._names["new"] = object.__new__
        fingerprint = self._constant("fingerprint", message_type._get_packed_fingerprint())
        self._line(f"if data[:8] != {fingerprint}:")
        self._line("    raise ValueError('wrong fingerprint')")
        self._arrays: list[str] = []  # lines that make arrays of the numbers that wait to be unpacked
        self._at, self._offset = "", 8  # where the next member begins: the value of a variable plus a number of bytes
        made = self._object(message_type)
        self._struct(message_type, made)
        self._flush_numbers()
        self._line(f"return {made}")

    @property
    def _place(self) -> str:
        return f"{self._at} + {self._offset}" if self._at else str(self._offset)

    def _object(self, message_type: type[Any]) -> str:
        made = self._fresh("struct")
        self._line(f"{made} = new({self._constant('type', message_type)})")
        return made

    def _fields(self, members: list[Member], owner: str) -> None:
        before, run = split_at_run(members)
        self._read(before, owner)
        if run:
            self._run(run, owner)
            self._fields(members[len(before) + len(run) :], owner)

    def _read(self, members: list[Member], owner: str) -> None:
        for name, kind, dimensions in members:
            if dimensions:
                self._array(kind, dimensions, owner, f"{owner}.{name}")
            else:
                self._single(kind, f"{owner}.{name}")

    def _run(self, members: list[Member], owner: str) -> None:
        self._flush_numbers()
        self._move(self._place)
        size = COUNT_BYTES * sum(not dimensions for _, _, dimensions in members)
        self._line(f"if data[at:at + {size}] == {self._constant('zeros', bytes(size))}:")
        self._indent += 1
        for name, kind, dimensions in members:
            self._line(f"{owner}.{name} = {_empty(kind) if dimensions else 0}")
        self._line(f"at += {size}")
        self._indent -= 1
        self._line("else:")
        self._indent += 1
        self._read(members, owner)
        self._flush_numbers()
        self._move(self._place)
        self._indent -= 1

    def _single(self, kind: str, target: str) -> None:
        if kind in DECODED:
            self._number(DECODED[kind], target)
        elif kind == "string":
            length = self._fresh("length")
            self._number("I", length)
            start = self._bytes(length)
            self._line(f"{target} = data[{start}:{self._at} - 1].decode('utf-8', 'replace')")
        else:
            made = self._object(type_named(kind))
            self._line(f"{target} = {made}")
            self._struct(type_named(kind), made)

    def _array(self, kind: str, dimensions: Dimensions, owner: str, target: str) -> None:
        first, *others = dimensions
        if self._is_unpacked_together(kind, dimensions):
            self._together(kind, dimensions, target)
            return
        self._flush_numbers()
        length = f"{owner}.{first}" if isinstance(first, str) else str(first)
        if isinstance(first, str):
            self._line(f"if {length} < 0:")
            self._line(f"    raise ValueError('{first} is negative')")
        if others:
            check_fixed(kind, dimensions)
            rows = [self._row(kind, int(others[0])) for _ in range(int(length))]
            self._line(f"{target} = [{', '.join(rows)}]")
        elif kind == "byte":
            start = self._bytes(length)
            self._line(f"{target} = data[{start}:{self._at}]")
        elif kind in DECODED and isinstance(first, int):
            self._line(f"{target} = {self._row(kind, first)}")
        elif kind in DECODED:
            values = f"{self._by_length(DECODED[kind], 'unpack_from')}[{length}](data, {self._place})"
            self._line(f"{target} = {_listed(kind, values)}")
            self._move(f"{self._place} + {struct.calcsize('>' + DECODED[kind])} * {length}")
        else:
            self._loop(kind, length, target)

    def _is_unpacked_together(self, kind: str, dimensions: Dimensions) -> bool:
        fixed = kind in DECODED and kind != "byte" and all(isinstance(size, int) for size in dimensions)
        return fixed and len(dimensions) <= 2 and math.prod(map(int, dimensions)) <= _TOGETHER_MOST

    def _together(self, kind: str, dimensions: Dimensions, target: str) -> None:
        """Unpacks an array of fixed size with the numbers before and after it."""
        rows = []
        for _ in range(int(dimensions[0]) if len(dimensions) == 2 else 1):
            values = [self._fresh("number") for _ in range(int(dimensions[-1]))]
            for value in values:
                self._number(DECODED[kind], value)
            rows.append(_listed(kind, f"({''.join(f'{value}, ' for value in values)})"))
        made = f"[{', '.join(rows)}]" if len(dimensions) == 2 else rows[0]
        self._arrays.append(f"{target} = {made}")

    def _row(self, kind: str, count: int) -> str:
        """Returns the expression of the values of an array of fixed size."""
        made = struct.Struct(f">{count}{DECODED[kind]}")
        unpack = self._constant("unpack", made.unpack_from)
        values = _listed(kind, f"{unpack}(data, {self._place})")
        self._offset += made.size
        return values

    def _loop(self, kind: str, length: str, target: str) -> None:
        self._move(self._place)
        values, item = self._fresh("list"), self._fresh("item")
        self._line(f"{target} = {values} = []")
        self._line(f"for _ in range({length}):")
        self._indent += 1
        self._single(kind, item)
        self._flush_numbers()
        self._line(f"{values}.append({item})")
        self._move(self._place)
        self._indent -= 1

    def _bytes(self, length: str) -> str:
        """Writes lines that skip bytes after checking that they exist; returns where they begin."""
        self._flush_numbers()
        start = self._fresh("start")
        self._line(f"{start} = {self._place}")
        self._move(f"{start} + {length}")
        self._line(f"if {self._at} > len(data):")
        self._line("    raise ValueError('the bytes end too early')")
        return start

    def _move(self, place: str) -> None:
        self._line(f"at = {place}")
        self._at, self._offset = "at", 0

    def _flush_numbers(self) -> None:
        if self._format:
            made = struct.Struct(f">{self._format}")
            unpack = self._constant("unpack", made.unpack_from)
            self._line(f"{', '.join(self._values)}, = {unpack}(data, {self._place})")
            self._offset += made.size
        for line in self._arrays:
            self._line(line)
        self._format, self._values, self._arrays = "", [], []


def _empty(kind: str) -> str:
    """Returns the expression of an array without members, as the decoder has it."""
    if kind == "byte":
        return "b''"
    return "()" if kind in CODES else "[]"


def _listed(kind: str, values: str) -> str:
    """Returns the expression of an array as lcm-gen makes it: booleans in lists, numbers in tuples."""
    return f"list({values})" if kind == "boolean" else values

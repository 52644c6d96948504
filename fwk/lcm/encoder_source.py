"""The source of an encoder of an LCM type."""

import struct
from typing import Any

from fwk.lcm.generated_source import (
    COUNT_BYTES,
    ENCODED,
    Dimensions,
    Member,
    Source,
    check_fixed,
    split_at_run,
    type_named,
)


class EncoderSource(Source):
    """Source of `encode`, the function for one type.

    Raises:
        RareShapeError: the type has a member of a rare shape.
    """

    def __init__(self, message_type: type[Any]) -> None:
        super().__init__("def encode(message):")
        self._names["join"] = b"".join
        self._chunks = [self._constant("fingerprint", message_type._get_packed_fingerprint())]
        self._listed = False  # whether some chunks are in a list already, because of loops
        self._struct(message_type, "message")
        self._flush_numbers()
        if self._listed:
            self._flush_chunks()
        self._line("return join(made)" if self._listed else f"return join(({', '.join(self._chunks)},))")

    def _fields(self, members: list[Member], owner: str) -> None:
        before, run = split_at_run(members)
        rest = members[len(before) + len(run) :]
        counts: dict[str, str] = {}
        self._set_counts([*before, *rest], owner, counts)
        self._write(before, owner, counts)
        if run:
            self._run(run, owner)
            self._fields(rest, owner)

    def _run(self, members: list[Member], owner: str) -> None:
        self._flush_numbers()
        self._flush_chunks()
        self._line(f"if {' or '.join(f'len({owner}.{name})' for name, _, dimensions in members if dimensions)}:")
        self._indent += 1
        counts: dict[str, str] = {}
        self._set_counts(members, owner, counts)
        self._write(members, owner, counts)
        self._flush_numbers()
        self._flush_chunks()
        self._indent -= 1
        own = [f"{owner}.{name}" for name, _, dimensions in members if not dimensions]
        self._line("else:")
        self._line(f"    {' = '.join(own)} = 0")
        self._line(f"    made.append({self._constant('zeros', bytes(COUNT_BYTES * len(own)))})")

    def _set_counts(self, members: list[Member], owner: str, counts: dict[str, str]) -> None:
        for name, _, dimensions in members:
            if dimensions and isinstance(dimensions[0], str):
                self._count(f"{owner}.{name}", f"{owner}.{dimensions[0]}", counts)

    def _write(self, members: list[Member], owner: str, counts: dict[str, str]) -> None:
        for name, kind, dimensions in members:
            if dimensions:
                self._array(kind, dimensions, f"{owner}.{name}", counts)
            else:
                self._single(kind, f"{owner}.{name}")

    def _count(self, values: str, count: str, counts: dict[str, str]) -> None:
        length = self._fresh("length")
        self._line(f"{length} = len({values})")
        if count in counts:
            self._line(f"if {length} != {counts[count]}:")
            self._line(f"    raise ValueError(\"the lists counted by '{count.partition('.')[2]}' differ in length\")")
        else:
            counts[count] = length
            self._line(f"{count} = {length}")

    def _single(self, kind: str, value: str) -> None:
        if kind in ENCODED:
            self._number(ENCODED[kind], value)
        elif kind == "string":
            text = self._fresh("text")
            self._line(f"{text} = {value}.encode() + b'\\0'")
            self._number("I", f"len({text})")
            self._chunk(text)
        else:
            owner = self._fresh("struct")
            self._line(f"{owner} = {value}")
            self._struct(type_named(kind), owner)

    def _array(self, kind: str, dimensions: Dimensions, values: str, counts: dict[str, str]) -> None:
        first, *others = dimensions
        length = counts[f"{values.rpartition('.')[0]}.{first}"] if isinstance(first, str) else str(first)
        if others:
            check_fixed(kind, dimensions)
            for index in range(int(length)):
                self._number(f"{others[0]}{ENCODED[kind]}", f"*{values}[{index}]")
            return
        if kind in ENCODED and kind != "byte":
            if isinstance(first, int):
                self._number(f"{first}{ENCODED[kind]}", f"*{values}")
            else:
                self._chunk(f"{self._by_length(ENCODED[kind], 'pack')}[{length}](*{values})")
            return
        if isinstance(first, int):
            self._line(f"if len({values}) != {first}:")
            self._line(f"    raise ValueError('{values.rpartition('.')[2]} is not an array of {first}')")
        if kind == "byte":
            self._chunk(f"bytes({values})")
            return
        self._flush_numbers()
        self._flush_chunks()
        item = self._fresh("item")
        self._line(f"for {item} in {values}:")
        self._indent += 1
        self._single(kind, item)
        self._flush_numbers()
        self._flush_chunks()
        self._line("pass")
        self._indent -= 1

    def _chunk(self, chunk: str) -> None:
        self._flush_numbers()
        self._chunks.append(chunk)

    def _flush_numbers(self) -> None:
        if self._format:
            pack = self._constant("pack", struct.Struct(f">{self._format}").pack)
            self._chunks.append(f"{pack}({', '.join(self._values)})")
        self._format, self._values = "", []

    def _flush_chunks(self) -> None:
        if self._chunks:
            self._line(f"made {'+=' if self._listed else '='} [{', '.join(self._chunks)}]")
            self._listed = True
        self._chunks = []

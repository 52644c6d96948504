"""Encoders and decoders of LCM types as generated straight-line Python: the bytes of lcm-gen in half the time.

They are generated from the description of the members that lcm-gen writes into each class. Types with members of rare
shapes (arrays of several dimensions whose sizes vary, a struct within itself) are left to the code of lcm-gen.
"""

import itertools
import struct
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any, cast

Encoder = Callable[[Any], bytes]
Decoder = Callable[[bytes], Any]

_CODES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "byte": "B"}
_COUNT_BYTES = 4
_ENCODED = {**_CODES, "boolean": "b"}
_DECODED = {**_CODES, "boolean": "?"}

Dimensions = list[int | str]
Member = tuple[str, str, Dimensions]
"""Name, type name and dimensions; without dimensions a single value."""


class _ByLength(dict[int, Callable[..., Any]]):
    """Packs or unpacks arrays of numbers: one method of a `struct.Struct` for each length that has occurred."""

    def __init__(self, code: str, method: str) -> None:
        super().__init__()
        self._code, self._method = code, method

    def __missing__(self, length: int) -> Callable[..., Any]:
        method: Callable[..., Any] = getattr(struct.Struct(f">{length}{self._code}"), self._method)
        if length <= _CACHED_LENGTH:
            self[length] = method
        return method


_CACHED_LENGTH = 256
"""Longer arrays take longer to convert than a format takes to read, and there may be arrays of any length."""


class RareShapeError(Exception):
    """A member has a shape that is left to the code of lcm-gen."""


@cache
def encoder(message_type: type[Any]) -> Encoder | None:
    """Returns a function that sets the counts of a message and encodes it; None for a rare shape.

    The function raises various exceptions for members with wrong values.
    """
    try:
        return _EncoderSource(message_type).function()
    except RareShapeError:
        return None


@cache
def decoder(message_type: type[Any]) -> Decoder | None:
    """Returns a function that decodes bytes; None for a rare shape.

    The function raises `ValueError` or `struct.error` for bytes that are not a message of the type.
    """
    try:
        return _DecoderSource(message_type).function()
    except RareShapeError:
        return None


class _Source(ABC):
    """Source of a function, to which each member of a type adds lines."""

    def __init__(self, head: str) -> None:
        self._lines = [head]
        self._indent = 1
        self._names: dict[str, Any] = {}
        self._numbers = itertools.count(1)
        self._format = ""  # of adjacent numbers, which are packed in one go
        self._values: list[str] = []
        self._within: list[type[Any]] = []  # the enclosing structs of the one that is being written

    def _line(self, text: str) -> None:
        self._lines.append("    " * self._indent + text)

    def _fresh(self, stem: str) -> str:
        return f"{stem}{next(self._numbers)}"

    def _constant(self, stem: str, value: Any) -> str:
        name = self._fresh(stem)
        self._names[name] = value
        return name

    def _by_length(self, code: str, method: str) -> str:
        """Returns the name of the methods that convert arrays of a kind of number, by length."""
        name = f"{method}_{'bool' if code == '?' else code}"
        self._names.setdefault(name, _ByLength(code, method))
        return name

    def _number(self, code: str, value: str) -> None:
        self._format += code
        self._values.append(value)

    def _compiled(self, name: str) -> Any:
        exec("\n".join(self._lines), self._names)
        return self._names[name]

    def _struct(self, message_type: type[Any], owner: str) -> None:
        if message_type in self._within:
            raise RareShapeError
        self._within.append(message_type)
        slots, kinds, shapes = message_type.__slots__, message_type.__typenames__, message_type.__dimensions__
        members = zip(slots, kinds, shapes, strict=True)
        self._fields([(name, kind, dimensions or []) for name, kind, dimensions in members], owner)
        self._within.pop()

    @abstractmethod
    def _fields(self, members: list[Member], owner: str) -> None:
        """Writes the lines for these members of `owner`."""


class _EncoderSource(_Source):
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

    def function(self) -> Encoder:
        return cast(Encoder, self._compiled("encode"))

    def _fields(self, members: list[Member], owner: str) -> None:
        before, run = _split_at_run(members)
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
        self._line(f"    made.append({self._constant('zeros', bytes(_COUNT_BYTES * len(own)))})")

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
        if kind in _ENCODED:
            self._number(_ENCODED[kind], value)
        elif kind == "string":
            text = self._fresh("text")
            self._line(f"{text} = {value}.encode() + b'\\0'")
            self._number("I", f"len({text})")
            self._chunk(text)
        else:
            owner = self._fresh("struct")
            self._line(f"{owner} = {value}")
            self._struct(_type(kind), owner)

    def _array(self, kind: str, dimensions: Dimensions, values: str, counts: dict[str, str]) -> None:
        first, *others = dimensions
        length = counts[f"{values.rpartition('.')[0]}.{first}"] if isinstance(first, str) else str(first)
        if others:
            _check_fixed(kind, dimensions)
            for index in range(int(length)):
                self._number(f"{others[0]}{_ENCODED[kind]}", f"*{values}[{index}]")
            return
        if kind in _ENCODED and kind != "byte":
            if isinstance(first, int):
                self._number(f"{first}{_ENCODED[kind]}", f"*{values}")
            else:
                self._chunk(f"{self._by_length(_ENCODED[kind], 'pack')}[{length}](*{values})")
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


class _DecoderSource(_Source):
    def __init__(self, message_type: type[Any]) -> None:
        super().__init__("def decode(data):")
        self._names["new"] = object.__new__
        fingerprint = self._constant("fingerprint", message_type._get_packed_fingerprint())
        self._line(f"if data[:8] != {fingerprint}:")
        self._line("    raise ValueError('wrong fingerprint')")
        self._at, self._offset = "", 8  # where the next member begins: the value of a variable plus a number of bytes
        made = self._object(message_type)
        self._struct(message_type, made)
        self._flush_numbers()
        self._line(f"return {made}")

    def function(self) -> Decoder:
        return cast(Decoder, self._compiled("decode"))

    @property
    def _place(self) -> str:
        return f"{self._at} + {self._offset}" if self._at else str(self._offset)

    def _object(self, message_type: type[Any]) -> str:
        made = self._fresh("struct")
        self._line(f"{made} = new({self._constant('type', message_type)})")
        return made

    def _fields(self, members: list[Member], owner: str) -> None:
        before, run = _split_at_run(members)
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
        size = _COUNT_BYTES * sum(not dimensions for _, _, dimensions in members)
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
        if kind in _DECODED:
            self._number(_DECODED[kind], target)
        elif kind == "string":
            length = self._fresh("length")
            self._number("I", length)
            start = self._bytes(length)
            self._line(f"{target} = data[{start}:{self._at} - 1].decode('utf-8', 'replace')")
        else:
            made = self._object(_type(kind))
            self._line(f"{target} = {made}")
            self._struct(_type(kind), made)

    def _array(self, kind: str, dimensions: Dimensions, owner: str, target: str) -> None:
        first, *others = dimensions
        self._flush_numbers()
        length = f"{owner}.{first}" if isinstance(first, str) else str(first)
        if isinstance(first, str):
            self._line(f"if {length} < 0:")
            self._line(f"    raise ValueError('{first} is negative')")
        if others:
            _check_fixed(kind, dimensions)
            rows = [self._row(kind, int(others[0])) for _ in range(int(length))]
            self._line(f"{target} = [{', '.join(rows)}]")
        elif kind == "byte":
            start = self._bytes(length)
            self._line(f"{target} = data[{start}:{self._at}]")
        elif kind in _DECODED and isinstance(first, int):
            self._line(f"{target} = {self._row(kind, first)}")
        elif kind in _DECODED:
            values = f"{self._by_length(_DECODED[kind], 'unpack_from')}[{length}](data, {self._place})"
            self._line(f"{target} = {_listed(kind, values)}")
            self._move(f"{self._place} + {struct.calcsize('>' + _DECODED[kind])} * {length}")
        else:
            self._loop(kind, length, target)

    def _row(self, kind: str, count: int) -> str:
        """Returns the expression of the values of an array of fixed size."""
        made = struct.Struct(f">{count}{_DECODED[kind]}")
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
        self._format, self._values = "", []


def _split_at_run(members: list[Member]) -> tuple[list[Member], list[Member]]:
    """Returns the members before the first run of lists that often are empty together, and the run.

    It has two counts or more, each right before all lists that it counts; the first count of all is not part of it.
    """
    ends = {}  # by place of a count: the place after its lists
    for index, (name, kind, dimensions) in enumerate(members):
        lists = [place for place, (_, _, shape) in enumerate(members) if name in shape]
        one_dimension = all(members[place][2] == [name] for place in lists)
        end = index + 1 + len(lists)
        if kind == "int32_t" and not dimensions and lists == list(range(index + 1, end)) and lists and one_dimension:
            ends[index] = end
    for index in list(ends)[1:]:
        end, groups = index, 0
        while end in ends:
            end, groups = ends[end], groups + 1
        if groups > 1:
            return members[:index], members[index:end]
    return members, []


def _empty(kind: str) -> str:
    """Returns the expression of an array without members, as the decoder has it."""
    if kind == "byte":
        return "b''"
    return "()" if kind in _CODES else "[]"


def _listed(kind: str, values: str) -> str:
    """Returns the expression of an array as lcm-gen makes it: booleans in lists, numbers in tuples."""
    return f"list({values})" if kind == "boolean" else values


def _check_fixed(kind: str, dimensions: Dimensions) -> None:
    """Leaves arrays of several dimensions to lcm-gen, except numbers in two fixed dimensions."""
    known = len(dimensions) == 2 and all(isinstance(size, int) for size in dimensions)
    if not known or kind not in _ENCODED or kind == "byte":
        raise RareShapeError


def _type(kind: str) -> type[Any]:
    package, _, name = kind.rpartition(".")
    return cast(type[Any], getattr(import_module(package), name))

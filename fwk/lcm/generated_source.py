"""The source of a generated encoder or decoder: lines of Python to which each member of an LCM type adds its own."""

import itertools
import struct
from abc import ABC, abstractmethod
from collections.abc import Callable
from importlib import import_module
from typing import Any, cast

CODES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "byte": "B"}
"""Formats of `struct` by type name."""
COUNT_BYTES = 4
"""Size of the count of a list."""
ENCODED = {**CODES, "boolean": "b"}
DECODED = {**CODES, "boolean": "?"}

Dimensions = list[int | str]
Member = tuple[str, str, Dimensions]
"""Name, type name and dimensions; without dimensions a single value."""


class RareShapeError(Exception):
    """A member has a shape that is left to the code of lcm-gen."""


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


class Source(ABC):
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

    def compiled(self, name: str) -> Any:
        """Returns the function, whose name is `name`."""
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


def split_at_run(members: list[Member]) -> tuple[list[Member], list[Member]]:
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


def check_fixed(kind: str, dimensions: Dimensions) -> None:
    """Leaves arrays of several dimensions to lcm-gen, except numbers in two fixed dimensions."""
    known = len(dimensions) == 2 and all(isinstance(size, int) for size in dimensions)
    if not known or kind not in ENCODED or kind == "byte":
        raise RareShapeError


def type_named(kind: str) -> type[Any]:
    """Returns the class of a struct, whose name has its package before a dot."""
    package, _, name = kind.rpartition(".")
    return cast(type[Any], getattr(import_module(package), name))

"""Finds mistakes in message types that lcm-gen accepts, or reports poorly."""

import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path

from fwk.lcm.lcm_file import INTEGERS, SIZES, LcmFile, Member, Struct

SIZE_MAX = 16 << 20
"""Largest size of a message without its arrays of variable length; larger data belongs into several messages."""
_STRUCT = re.compile(r"\bstruct\s+(\w+)")
_PACKAGE = re.compile(r"^\s*package\s+([\w.]+)\s*;", re.M)
_OF_CLASSES = frozenset(
    [
        "encode",
        "decode",
        "get_hash",
        "_encode_one",
        "_decode_one",
        "_get_hash_recursive",
        "_get_packed_fingerprint",
        "_packed_fingerprint",
        "_set_members",
    ]
)
"""Names that lcm-gen and `typegen` give to attributes of every class."""


def mistakes_in(files: Sequence[LcmFile]) -> list[str]:
    """Returns all mistakes in the .lcm files of a folder as `FILE:LINE: mistake`."""
    structs = {struct.full_name: struct for file in files for struct in file.structs}
    return [
        f"{struct.file}:{line}: {text}"
        for line, text, struct in (
            *_twice(files),
            *(each for struct in structs.values() for each in _in_struct(struct, structs)),
        )
    ]


Mistake = tuple[int, str, Struct]


def _twice(files: Iterable[LcmFile]) -> Iterator[Mistake]:
    first: dict[str, Struct] = {}
    for struct in (struct for file in files for struct in file.structs):
        other = first.setdefault(struct.full_name, struct)
        if other is not struct:
            place = f"line {other.line}" if other.file == struct.file else f"{other.file.name}:{other.line}"
            yield struct.line, f"struct {struct.full_name} is defined already, in {place}; keep one", struct


def _in_struct(struct: Struct, structs: Mapping[str, Struct]) -> Iterator[Mistake]:
    lines: dict[str, int] = {}
    for member in (*struct.constants, *struct.members):
        if member.name in _OF_CLASSES or member.name.startswith("__"):
            yield member.line, f"'{member.name}' is a name of every generated class; choose another name", struct
        if member.name in lines:
            yield member.line, f"{struct.name} has a '{member.name}' already, in line {lines[member.name]}", struct
        lines.setdefault(member.name, member.line)
    broken = False
    for member in struct.members:
        text = _type_mistake(struct, member, structs) or _dimension_mistake(struct, member)
        if text:
            broken = True
            yield member.line, text, struct
    if broken:
        return
    if ring := _ring(struct, structs, []):
        if ring[0] != struct.full_name:
            return
        text = f"{struct.name} contains itself: {' -> '.join(ring)}; only an array of variable length may do that"
        yield struct.line, text, struct
        return
    size, largest = _size(struct, structs)
    if size > SIZE_MAX and largest:
        text = f"'{largest.name}' makes {struct.name} {size:,} bytes long; a message type has at most {SIZE_MAX:,}"
        yield largest.line, text, struct


def _type_mistake(struct: Struct, member: Member, structs: Mapping[str, Struct]) -> str:
    name = struct.full_type(member)
    if name in SIZES or name in structs:
        return ""
    package, _, short = name.rpartition(".")
    known = {each.name for each in structs.values() if each.package == package} | _installed(package)
    if short in known:
        return ""
    choices = [*SIZES, *(each.name for each in structs.values() if each.package == struct.package)]
    near = get_close_matches(short, known if "." in member.type else choices, 1)
    if near:
        meant = near[0] if near[0] in choices else f"{package}.{near[0]}"
        return f"there is no type '{member.type}'; did you mean '{meant}'?"
    there = f"; package {package} has {', '.join(sorted(known)[:12])}" if "." in member.type and known else ""
    return f"there is no type '{member.type}'{there}"


def _installed(package: str) -> set[str]:
    """Returns the names of a package's structs in all folders where Python finds message types."""
    found: set[str] = set()
    for folder in [Path(entry) / "lcmtypes" for entry in sys.path]:
        found |= {file.stem for file in (folder / package.replace(".", "/")).glob("*.pyi")}
        for source in folder.glob("*.lcm"):
            text = source.read_text(errors="replace")
            named = _PACKAGE.search(text)
            if named and named[1] == package:
                found |= set(_STRUCT.findall(text))
    return found


def _dimension_mistake(struct: Struct, member: Member) -> str:
    constants = {constant.name for constant in struct.constants if constant.type in INTEGERS}
    earlier = struct.members[: struct.members.index(member)]
    counts = {each.name for each in earlier if each.type in INTEGERS and not each.dimensions}
    for dimension in member.dimensions:
        if dimension.isdecimal():
            if not int(dimension):
                return f"'{member.name}' has room for nothing; the size of an array is at least 1"
        elif dimension not in constants | counts:
            right = "a number, an integer constant, or an integer member in a line above"
            return f"the size of '{member.name}' is '{dimension}'; it should be {right}"
    return ""


def _fixed(struct: Struct, member: Member) -> int | None:
    """Returns the number of values of a member; None for a variable length."""
    values = {constant.name: constant.value for constant in struct.constants}
    sizes = [values.get(dimension, dimension) for dimension in member.dimensions]
    try:
        return math.prod(int(size, 0) for size in sizes)
    except ValueError:
        return None


def _ring(struct: Struct, structs: Mapping[str, Struct], way: list[str]) -> list[str]:
    """Returns the names of structs that contain each other, from this one on; empty if there are none."""
    if struct.full_name in way:
        return [*way[way.index(struct.full_name) :], struct.full_name]
    for member in struct.members:
        inner = structs.get(struct.full_type(member))
        if inner and _fixed(struct, member) is not None:
            found = _ring(inner, structs, [*way, struct.full_name])
            if found:
                return found
    return []


def _size(struct: Struct, structs: Mapping[str, Struct]) -> tuple[int, Member | None]:
    """Returns the size of a message with empty strings and arrays in bytes, and its largest member."""
    sizes: list[tuple[int, Member]] = []
    for member in struct.members:
        inner = structs.get(struct.full_type(member))
        count = _fixed(struct, member) or 0
        each = 0 if not count else _size(inner, structs)[0] if inner else SIZES.get(member.type, 0)
        sizes.append((count * each, member))
    largest = max(sizes, key=lambda each: each[0], default=(0, None))[1]
    return sum(size for size, _ in sizes), largest

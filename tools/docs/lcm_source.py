"""Reads .lcm files with their comments, which lcm-gen drops."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

_PACKAGE = re.compile(r"package\s+([\w.]+)\s*;")
_STRUCT = re.compile(r"struct\s+(\w+)\s*\{?")
_CONSTANT = re.compile(r"const\s+(\w+)\s+(\w+)\s*=\s*([^;]+);")
_MEMBER = re.compile(r"([\w.]+)\s+(\w+)\s*((?:\[\s*\w+\s*\]\s*)*);")


class LcmSourceError(Exception):
    """A line of an .lcm file that the reader does not understand; the text names file and line."""


@dataclass(slots=True)
class Member:
    """One member or constant of a struct."""

    type: str
    """As written: `double`, `header_t`, `robot.pose_t`."""
    name: str
    dimensions: str = ""
    """As written: `[3]`, `[n_marks]`, or empty."""
    value: str = ""
    """Value of a constant; empty for a member."""
    comment: str = ""


@dataclass(slots=True)
class Struct:
    """One message type."""

    package: str
    name: str
    comment: str
    members: list[Member] = field(default_factory=list)
    constants: list[Member] = field(default_factory=list)

    @property
    def full_name(self) -> str:
        """Name with the package: `robot.pose_t`."""
        return f"{self.package}.{self.name}"


def read_structs(path: Path) -> list[Struct]:
    """Returns the structs of an .lcm file in their order, with the comments above and beside them.

    Raises:
        LcmSourceError: a line is neither a comment nor a package, struct, member or constant.
    """
    package, above = "", ""
    structs: list[Struct] = []
    last: Member | None = None
    inside = False
    for number, code, comment in _lines(path):
        if not code:
            if inside and last is not None and comment:
                last.comment = _joined(last.comment, comment)
            else:
                above = _joined(above, comment) if comment else ""
        elif found := _PACKAGE.fullmatch(code):
            package = found[1]
        elif found := _STRUCT.fullmatch(code):
            structs.append(Struct(package, found[1], _joined(above, comment)))
            above, last, inside = "", None, True
        elif code.startswith("}"):
            inside, last = False, None
        elif inside and (member := _member(code)):
            last = member
            last.comment = _joined(above, comment)
            above = ""
            struct = structs[-1]
            (struct.constants if member.value else struct.members).append(member)
        elif code != "{":
            raise LcmSourceError(f"{path}:{number}: cannot read '{code}'; one member or constant a line is expected")
    return structs


def _lines(path: Path) -> Iterator[tuple[int, str, str]]:
    """Yields line number, code and comment of each line."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code, _, comment = line.partition("//")
        yield number, code.strip(), comment.strip()


def _member(code: str) -> Member | None:
    if found := _CONSTANT.fullmatch(code):
        return Member(found[1], found[2], value=found[3].strip())
    if found := _MEMBER.fullmatch(code):
        return Member(found[1], found[2], dimensions=found[3].replace(" ", ""))
    return None


def _joined(*parts: str) -> str:
    return " ".join(part for part in parts if part)

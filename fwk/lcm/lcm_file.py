"""Reads .lcm files: packages, structs, members, and the place of each syntax error."""

import keyword
import re
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

RENAMED = {f"robot.{name}": f"core.{name}" for name in ("frame_t", "picture_t", "transform_t", "transforms_t")}
"""Present names of types by former ones, as in earlier programs, launch files and recordings.

Fingerprints do not depend on names.
"""

_TOKEN = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<word>[A-Za-z_][\w.]*)|(?P<number>[-+]?[0-9][\w.+-]*|[-+]\.?\w+)"
    r"|(?P<sign>[{}\[\];,=])|(?P<space>\s+)|(?P<other>.)",
    re.S,
)
INTEGERS = {"int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8}
SIZES = {**INTEGERS, "float": 4, "double": 8, "byte": 1, "boolean": 1, "string": 5}
"""Bytes of a value of each primitive type; for a string those of an empty one."""


class LcmSyntaxError(Exception):
    """An .lcm file cannot be read; the text names file, line and the expected token."""


@dataclass(frozen=True)
class Member:
    """One member or constant of a struct; `dimensions` are numbers, constants or members, as written."""

    type: str
    name: str
    line: int
    dimensions: tuple[str, ...] = ()
    value: str = ""
    """Value of a constant; empty for a member."""


@dataclass(frozen=True)
class Struct:
    """A message type."""

    package: str
    name: str
    file: Path
    line: int
    members: tuple[Member, ...]
    constants: tuple[Member, ...]

    @property
    def full_name(self) -> str:
        """Name with the package: `core.frame_t`."""
        return f"{self.package}.{self.name}"

    def full_type(self, member: Member) -> str:
        """Returns the type of a member; a struct's type with its package."""
        return member.type if member.type in SIZES or "." in member.type else f"{self.package}.{member.type}"


@dataclass(frozen=True)
class LcmFile:
    """Content of an .lcm file."""

    path: Path
    text: str
    package: str
    structs: tuple[Struct, ...]


def read_lcm_file(path: Path) -> LcmFile:
    """Reads an .lcm file.

    Raises:
        LcmSyntaxError: the text is not UTF-8 or not LCM.
        OSError: the file cannot be read.
    """
    data = path.read_bytes()
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        byte = data[error.start]
        raise LcmSyntaxError(f"{path}:{line}: byte 0x{byte:02x} is not UTF-8; save the file as UTF-8") from error
    return _parsed(path, text)


@lru_cache(maxsize=128)
def _parsed(path: Path, text: str) -> LcmFile:
    """Returns the content of a file with this text; a command reads the files of its types several times."""
    return _Parser(path, text).file()


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    line: int


@dataclass
class _Parser:
    path: Path
    text: str
    tokens: list[_Token] = field(default_factory=list)
    at: int = 0

    def file(self) -> LcmFile:
        self._tokenize()
        if self._next.text != "package":
            raise self._wrong(1, "no 'package NAME;' line; every .lcm file names its package")
        self._take()
        package = self._word("the name of the package")
        self._sign(";")
        structs = []
        while self._next.kind != "end":
            if self._next.text not in ("struct", "enum"):
                raise self._wrong(
                    self._next.line, f"'{self._next.text}' is not expected here; a struct begins with 'struct NAME {{'"
                )
            structs.append(self._struct(package))
        return LcmFile(self.path, self.text, package, tuple(structs))

    def _tokenize(self) -> None:
        line = 1
        for found in _TOKEN.finditer(self.text):
            kind = found.lastgroup or "other"
            if kind not in ("comment", "space"):
                self.tokens.append(_Token(kind, found[0], line))
            line += found[0].count("\n")
        self.tokens.append(_Token("end", "the end of the file", line))

    @property
    def _next(self) -> _Token:
        return self.tokens[self.at]

    def _take(self) -> _Token:
        self.at += 1
        return self.tokens[self.at - 1]

    def _wrong(self, line: int, text: str) -> LcmSyntaxError:
        return LcmSyntaxError(f"{self.path}:{line}: {text}")

    def _sign(self, wanted: str) -> None:
        """Takes a sign; a missing one is reported after the preceding token."""
        if self._next.text != wanted:
            before = self.tokens[self.at - 1]
            raise self._wrong(before.line, f"'{wanted}' is missing after '{before.text}'")
        self._take()

    def _word(self, what: str) -> str:
        if self._next.kind != "word":
            before = self.tokens[self.at - 1]
            raise self._wrong(before.line, f"{what} is missing after '{before.text}'")
        return self._take().text

    def _name(self, what: str) -> str:
        name = self._word(what)
        if "." in name or keyword.iskeyword(name):
            reason = "a keyword of Python" if keyword.iskeyword(name) else "not one word"
            raise self._wrong(self.tokens[self.at - 1].line, f"'{name}' is {reason}; choose another name")
        return name

    def _struct(self, package: str) -> Struct:
        if self._take().text == "enum":
            raise self._wrong(
                self.tokens[self.at - 1].line,
                "enum is not supported; write constants into a struct: const int8_t RED = 1;",
            )
        line = self._next.line
        name = self._name("the name of the struct")
        self._sign("{")
        members: list[Member] = []
        constants: list[Member] = []
        while self._next.text != "}":
            if self._next.kind == "end" or self._next.text in ("struct", "package"):
                raise self._wrong(line, f"'}}' of struct {name} is missing")
            constant = self._next.text == "const"
            if constant:
                self._take()
            self._statement(constants if constant else members, constant)
        self._take()
        if self._next.text == ";":
            self._take()
        return Struct(package, name, self.path, line, tuple(members), tuple(constants))

    def _statement(self, into: list[Member], constant: bool) -> None:
        kind = self._word("a type")
        while True:
            name, line = self._name(f"the name of the {'constant' if constant else 'member'}"), self._next.line
            line = self.tokens[self.at - 1].line
            dimensions, value = [], ""
            while not constant and self._next.text == "[":
                self._take()
                dimensions.append(self._take().text)
                self._sign("]")
            if constant:
                self._sign("=")
                value = self._take().text
            into.append(Member(kind, name, line, tuple(dimensions), value))
            if self._next.text != ",":
                break
            self._take()
        self._sign(";")

"""Generates Python classes and type stubs from .lcm files with lcm-gen."""

import re
import subprocess
import sys
from pathlib import Path

import lcm

_STRUCT = re.compile(r"struct\s+(\w+)\s*\{(.*?)\}", re.S)
_PACKAGE = re.compile(r"^\s*package\s+([\w.]+)\s*;", re.M)
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
_MEMBER = re.compile(r"^([\w.]+)\s+(\w+)((?:\s*\[\s*\w+\s*\])*)$")
_INTEGERS = {"int8_t", "int16_t", "int32_t", "int64_t"}
_PRIMITIVES = {
    **dict.fromkeys(_INTEGERS, "int"),
    "float": "float",
    "double": "float",
    "string": "str",
    "boolean": "bool",
}

_STUB_ATTRIBUTES = [
    "    __slots__: ClassVar[list[str]]",
    "    __typenames__: ClassVar[list[str]]",
    "    __dimensions__: ClassVar[list[list[int | str] | None]]",
]
_STUB_METHODS = [
    "    def encode(self) -> bytes: ...",
    "    @staticmethod",
    "    def decode(data: bytes) -> NAME: ...",
    "    @staticmethod",
    "    def _get_packed_fingerprint() -> bytes: ...",
    "    def get_hash(self) -> int: ...",
    "",
]


class TypeGenerationError(Exception):
    """lcm-gen refused a file; the text is lcm-gen's own, with file and line."""


def lcm_gen() -> Path:
    """Path of the lcm-gen program that the lcm wheel brings."""
    return Path(lcm.__file__).parent.parent / "bin" / "lcm-gen"


def generate(folder: Path) -> list[Path]:
    """Generates `folder`/<package>/*.py and *.pyi from every .lcm file in `folder`; returns the packages written.

    `folder` has to be called `lcmtypes`: it is one part of the namespace package of that name, so that types of several
    folders live side by side. Files that are newer than their sources are left alone.

    Raises:
        TypeGenerationError: a file does not parse, or lcm-gen cannot be run.
    """
    sources = sorted(folder.glob("*.lcm"))
    written = []
    for source in sources:
        text = source.read_text()
        found = _PACKAGE.search(text)
        if not found:
            raise TypeGenerationError(f"{source}:1: no 'package NAME;' line; every .lcm file names its package")
        package = folder / found[1].replace(".", "/")
        written.append(package)
        mark = package / f".{source.stem}.generated"
        if mark.exists() and mark.stat().st_mtime_ns >= source.stat().st_mtime_ns:
            continue
        _run_lcm_gen(source)
        _write_stubs(package, text)
        mark.touch()
    (folder / "__init__.py").unlink(
        missing_ok=True
    )  # lcm-gen writes one; without it the folder joins a namespace package
    return written


def _run_lcm_gen(source: Path) -> None:
    command = [
        str(lcm_gen()),
        "--python",
        "--package-prefix",
        "lcmtypes",
        "--ppath",
        str(source.parent.parent),
        str(source),
    ]
    try:
        result = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise TypeGenerationError(f"{source}: cannot run {command[0]}: {error}") from error
    if result.returncode:
        raise TypeGenerationError(f"{source}: {(result.stderr or result.stdout).strip()}")


def _write_stubs(package: Path, text: str) -> None:
    for name, body in _STRUCT.findall(_COMMENT.sub("", text)):
        constants, members, imports = _members(package.name, body)
        lines = ["from typing import ClassVar", "", *sorted(imports - {_import(package.name, name)}), ""]
        lines += [f"class {name}:", *_STUB_ATTRIBUTES]
        lines += [f"    {constant}: ClassVar[{kind}]" for constant, kind in constants]
        lines += [f"    {member}: {kind}" for member, kind in members]
        lines += [method.replace("NAME", name) for method in _STUB_METHODS]
        (package / f"{name}.pyi").write_text("\n".join(lines))


def _members(own: str, body: str) -> tuple[list[tuple[str, str]], list[tuple[str, str]], set[str]]:
    constants, members, imports = [], [], set()
    for statement in body.split(";"):
        words = " ".join(statement.split())
        if words.startswith("const "):
            kind, rest = words[6:].split(" ", 1)
            constants += [(part.split("=")[0].strip(), _PRIMITIVES[kind]) for part in rest.split(",")]
            continue
        found = _MEMBER.match(words)
        if not found:
            continue
        lcm_type, member, dimensions = found.groups()
        depth = dimensions.count("[")
        if lcm_type == "byte":
            kind, depth = ("int", 0) if depth == 0 else ("bytes", depth - 1)
        elif lcm_type in _PRIMITIVES:
            kind = _PRIMITIVES[lcm_type]
        else:
            package, _, kind = lcm_type.rpartition(".")
            imports.add(_import(package or own, kind))
        for _ in range(depth):
            kind = f"list[{kind}]"
        members.append((member, kind))
    return constants, members, imports


def _import(package: str, name: str) -> str:
    return f"from lcmtypes.{package}.{name} import {name}"


def main() -> None:
    """Generates the types of the folders named on the command line: python -m fwk.lcm.typegen lcmtypes."""
    for folder in sys.argv[1:]:
        generate(Path(folder).resolve())


if __name__ == "__main__":
    main()

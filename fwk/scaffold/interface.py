"""Makes message types: a struct in an .lcm file of the project."""

import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from fwk.lcm.lcm_file import SIZES, LcmSyntaxError, read_lcm_file
from fwk.lcm.type_mistakes import mistakes_in
from fwk.lcm.typegen import TypeGenerationError, generate
from fwk.model.errors import hint
from fwk.scaffold.changes import Change, ScaffoldError, content, edited
from fwk.scaffold.project import Project, check_name, check_types_are_free

_FIELD = re.compile(r"(?P<name>\w+):(?P<type>[A-Za-z_][\w.]*)(?P<sizes>(\[\w+\])*)", re.ASCII)
_OF_PYTHON = {"int": "int64_t", "str": "string", "bool": "boolean", "bytes": "byte[n]"}
_HEADER = ("core.header_t", "header", "tick, sequence number, time and writer; written by the framework")
_COMMAND = ("core.command_t", "command", "written by the framework, as the header is")
_ANSWER = ("core.answer_t", "answer", "outcome of the request; written by the framework")
_FIRST = {"message": (_HEADER,), "request": (_HEADER, _COMMAND), "reply": (_HEADER, _ANSWER), "plain": ()}
KINDS = tuple(_FIRST)
"""`request` is for commands, too; `plain` is a type of a device, without header."""


def new_interface(project: Project, name: str, fields: Sequence[str], kind: str = "message") -> Change:
    """Returns the .lcm file with a new struct, made or extended.

    Args:
        project: Project that gets the type.
        name: `PACKAGE.NAME`, or `NAME` for both; the struct gets the ending `_t`.
        fields: Members as `NAME:TYPE`, such as `x_m:double` or `ranges_m:float[n]`.
        kind: One of `KINDS`.

    Raises:
        ScaffoldError: a name, a type or the kind cannot be used, or the struct exists.
    """
    if kind not in KINDS:
        raise ScaffoldError(f"no kind of message type '{kind}'; {hint(kind, KINDS)}")
    package, _, short = name.removesuffix("_t").rpartition(".")
    check_name(short, "a message type")
    package = check_name(package or short, "a package of message types")
    check_types_are_free(package, project.root)
    members = [*_FIRST[kind], *(_member(each) for each in fields)]
    path = project.root / "lcmtypes" / f"{package}.lcm"
    before = content(path) if path.is_file() else f"package {package};\n"
    after = f"{before.rstrip()}\n\n{_struct(f'{short}_t', members)}"
    _check(project.root / "lcmtypes", path, after)
    return edited(path, after) if path.is_file() else Change(path, after)


def generate_types(project: Project) -> list[Path]:
    """Generates the Python classes of all .lcm files of a project; returns the packages.

    Raises:
        ScaffoldError: an .lcm file has mistakes.
    """
    try:
        return generate((project.root / "lcmtypes").resolve())
    except TypeGenerationError as error:
        raise ScaffoldError(str(error)) from error


def _member(text: str) -> tuple[str, str, str]:
    found = _FIELD.fullmatch(text)
    if not found:
        raise ScaffoldError(f"'{text}' is not a field; write NAME:TYPE, such as x_m:double or ranges_m:float[8]")
    kind = found["type"]
    if kind in _OF_PYTHON:
        raise ScaffoldError(f"'{text}': LCM has no type '{kind}'; write {found['name']}:{_OF_PYTHON[kind]}")
    if "." not in kind and not kind.endswith("_t") and kind not in SIZES:
        raise ScaffoldError(f"'{text}': there is no type '{kind}'; {hint(kind, SIZES)}")
    return kind, found["name"] + found["sizes"], ""


def _struct(name: str, members: Sequence[tuple[str, str, str]]) -> str:
    kinds = max((len(kind) for kind, _, _ in members), default=0)
    names = max((len(member) for _, member, comment in members if comment), default=0)
    lines = [
        f"  {kind:{kinds}} {f'{member};':{names + 1}}  // {comment}" if comment else f"  {kind:{kinds}} {member};"
        for kind, member, comment in members
    ]
    return "\n".join([f"struct {name} {{", *lines, "}\n"])


def _check(folder: Path, path: Path, after: str) -> None:
    """Reads all types of the project together with the changed file.

    Raises:
        ScaffoldError: the mistakes, with file and line.
    """
    with tempfile.TemporaryDirectory() as made:
        copies = {path.name: after}
        copies |= {each.name: content(each) for each in sorted(folder.glob("*.lcm")) if each != path}
        for name, text in copies.items():
            (Path(made) / name).write_text(text)
        try:
            mistakes = mistakes_in([read_lcm_file(Path(made) / name) for name in sorted(copies)])
        except LcmSyntaxError as error:
            mistakes = [str(error)]
    if mistakes:
        raise ScaffoldError("\n".join(mistake.replace(f"{made}/", "lcmtypes/") for mistake in mistakes))

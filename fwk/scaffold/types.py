"""Message types that a project can use: its own and the installed ones."""

from collections.abc import Sequence
from pathlib import Path

import lcmtypes
from fwk.lcm.lcm_file import LcmSyntaxError, Struct, read_lcm_file
from fwk.model.errors import hint
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.project import Project


def type_folders(project: Project) -> list[Path]:
    """Returns the folders with .lcm files, that of the project first."""
    own = (project.root / "lcmtypes").resolve()
    return [
        own,
        *(folder for folder in dict.fromkeys(Path(each).resolve() for each in lcmtypes.__path__) if folder != own),
    ]


def known_types(project: Project) -> dict[str, Struct]:
    """Returns the message types by full name, such as `garden.ball_t`.

    Raises:
        ScaffoldError: an .lcm file of the project is not valid.
    """
    found: dict[str, Struct] = {}
    for folder in type_folders(project):
        for path in sorted(folder.glob("*.lcm")):
            try:
                file = read_lcm_file(path)
            except LcmSyntaxError as error:
                raise ScaffoldError(str(error)) from error
            for struct in file.structs:
                found.setdefault(struct.full_name, struct)
    return found


def check_type(project: Project, name: str) -> str:
    """Returns the full name of a message type; without a package, the only type of that name.

    Raises:
        ScaffoldError: there is no such type, or several packages have one.
    """
    known = known_types(project)
    alike = [full for full in known if full == name or full.endswith(f".{name}")]
    if len(alike) == 1:
        return alike[0]
    if alike:
        raise ScaffoldError(f"several types '{name}': {', '.join(alike)}; write it with its package")
    raise ScaffoldError(f"no message type '{name}'; {hint(name, known)}")


def check_port_types(project: Project, kind: str, names: Sequence[str]) -> tuple[str, ...]:
    """Returns the full names of the types of a port; `kind` is reads, writes, serves or calls.

    Raises:
        ScaffoldError: there is no such type, or a port of that kind cannot have it.
    """
    full = tuple(check_type(project, each) for each in names)
    roles = (("request", "command"), ("reply", "answer")) if kind in ("serves", "calls") else (("message", ""),)
    if len(full) > len(roles):
        right = "a request, and a reply if it has one" if len(roles) > 1 else "one message type"
        raise ScaffoldError(f"'{','.join(names)}' are {len(full)} types; {kind} takes {right}")
    known = known_types(project)
    for name, (role, member) in zip(full, roles, strict=False):
        found = [(each.type, each.name) for each in known[name].members[:2]]
        if member and found != [("core.header_t", "header"), (f"core.{member}_t", member)]:
            package = name.partition(".")[0]
            raise ScaffoldError(
                f"{name} is not a {role}: its first members are not 'core.header_t header; core.{member}_t {member};'; "
                f"make one with: fwk new interface {package}.NAME FIELD:TYPE --kind {role}"
            )
    return full

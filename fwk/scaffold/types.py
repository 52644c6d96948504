"""Message types that a project can use: its own and the installed ones."""

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

"""Comments beside the members of types in .lcm files: `double x_m;  // world frame`."""

from functools import cache

from fwk.lcm.lcm_file import LcmSyntaxError, Struct, read_lcm_file
from fwk.lcm.type_registry import source_folders

NEEDED = "has to be given"
"""In the comment of a member: a command that leaves the member out is refused."""


@cache
def comment_of(type_name: str, member: str) -> str:
    """Returns the comment in the line of a member; empty if there is none, or no .lcm file of the type."""
    struct = _structs().get(type_name)
    line = next((each.line for each in struct.members if each.name == member), 0) if struct else 0
    return struct.file.read_text().splitlines()[line - 1].partition("//")[2].strip() if struct and line else ""


@cache
def _structs() -> dict[str, Struct]:
    found: dict[str, Struct] = {}
    for folder in source_folders():
        for path in sorted(folder.glob("*.lcm")):
            try:
                found |= {struct.full_name: struct for struct in read_lcm_file(path).structs}
            except (LcmSyntaxError, OSError):
                continue
    return found

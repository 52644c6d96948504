"""Frames of reference of members, from the comments in .lcm files: `double x_m;  // world frame`."""

import re
from functools import cache

from fwk.lcm.lcm_file import LcmSyntaxError, Struct, read_lcm_file
from fwk.lcm.type_registry import source_folders

WORLD = "world"
"""Frame of positions without a comment, and parent of all others."""
_COMMENT = re.compile(r"//.*?\b([A-Za-z]\w*) frame\b")


@cache
def comment_frame(type_name: str, member: str) -> str:
    """Returns the frame that the comment of a member names, such as `world` or `robot`; empty: none."""
    struct = _structs().get(type_name)
    lines = {each.name: each.line for each in struct.members} if struct else {}
    if struct is None or member not in lines:
        return ""
    found = _COMMENT.search(struct.file.read_text().splitlines()[lines[member] - 1])
    return found[1].lower() if found else ""


def full_frame(frame: str, channel: str) -> str:
    """Returns the frame in the tree of all robots: `cyan1/robot` for the frame `robot` on a channel of cyan1."""
    namespace = channel.rpartition("/")[0]
    return frame if frame in ("", WORLD) or not namespace else f"{namespace}/{frame}"


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

"""Frames of reference of members, from the comments in .lcm files: `double x_m;  // world frame`."""

import re
from functools import cache

from fwk.lcm.comments import comment_of

WORLD = "world"
"""Frame of positions without a comment, and parent of all others."""
_COMMENT = re.compile(r"\b([A-Za-z]\w*) frame\b")


@cache
def comment_frame(type_name: str, member: str) -> str:
    """Returns the frame that the comment of a member names, such as `world` or `robot`; empty: none."""
    found = _COMMENT.search(comment_of(type_name, member))
    return found[1].lower() if found else ""


def full_frame(frame: str, channel: str) -> str:
    """Returns the frame in the tree of all robots: `cyan1/robot` for the frame `robot` on a channel of cyan1."""
    namespace = channel.rpartition("/")[0]
    return frame if frame in ("", WORLD) or not namespace else f"{namespace}/{frame}"

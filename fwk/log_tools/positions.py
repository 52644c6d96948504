"""Positions in messages: structs with the members `x_m` and `y_m`, each with its frame of reference."""

import math
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

from fwk.lcm.messages import Message, type_name, type_named
from fwk.log_tools.frames import WORLD, comment_frame
from fwk.log_tools.plain import members_of

_ABSENT = ("known", "visible", "localized")
"""Members that say, when false, that the position of their struct means nothing."""


class Position(NamedTuple):
    """A struct with a position in a message."""

    path: str
    """Members that lead to it, each followed by a space; empty: the message itself."""
    frame: str
    struct: Any


def positions_in(message: Any) -> list[Position] | None:
    """Returns the positions that mean something; None: the type of the message has none."""
    if not _may_have_position(type_name(type(message))):
        return None
    return [position for position in _places(message) if _is_there(position.struct)]


def _places(message: Any, path: str = "", outer: str = WORLD) -> Iterator[Position]:
    """Yields the structs with a position in a message, each with its frame."""
    kind = type_name(type(message))
    frame = comment_frame(kind, "x_m") or outer
    if _has_position(kind):
        yield Position(path, frame, message)
    for name, member, dimensions in members_of(type(message)):
        if "." not in member or member == "core.header_t" or len(dimensions) > 1:
            continue
        value, inner = getattr(message, name), comment_frame(kind, name) or frame
        for number, each in enumerate(value if dimensions else (value,)):
            yield from _places(each, f"{path}{name}{number if dimensions else ''} ", inner)


@cache
def _may_have_position(kind: str) -> bool:
    """Returns whether a type, or a type nested in it, has a position."""
    inner = [member for _, member, dimensions in members_of(type_named(kind)) if "." in member and len(dimensions) <= 1]
    return _has_position(kind) or any(map(_may_have_position, inner))


@cache
def _has_position(kind: str) -> bool:
    message_type: type[Message] = type_named(kind)
    return {"x_m", "y_m"} <= {name for name, _, dimensions in members_of(message_type) if not dimensions}


def _is_there(struct: Any) -> bool:
    finite = math.isfinite(struct.x_m) and math.isfinite(struct.y_m)
    return finite and all(getattr(struct, name, True) for name in _ABSENT)

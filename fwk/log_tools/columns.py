"""Messages as rows of a table.

Members of a struct become columns of their own, `ball.x_m`, and so do the elements of arrays of constant size,
`covariance.0.1`. An array of variable size, or of more than 64 elements, is one column with a list.
"""

import re
from collections.abc import Callable
from itertools import product
from math import prod
from operator import attrgetter
from typing import Any

from fwk.lcm.messages import Message, type_named
from fwk.log_tools.plain import members_of

ELEMENTS_MAX = 64


class Column:
    """Column of a table: one value of each message.

    Args:
        name: path to the value, such as `ball.x_m` or `covariance.0.1`.
        kind: LCM type of the value, or of the elements of a list.
        dimensions: those of a list; empty for one value.
    """

    def __init__(self, name: str, kind: str, dimensions: tuple[int | str, ...] = ()) -> None:
        self.name = name
        self.kind = kind
        self.dimensions = dimensions
        self.value: Callable[[Any], Any] = _getter(name)
        """Returns the value of a message."""


def columns_of(message_type: type[Message], prefix: str = "") -> list[Column]:
    """Returns the columns of a type in the order of its members."""
    made: list[Column] = []
    for name, kind, dimensions in members_of(message_type):
        sizes = [size for size in dimensions if isinstance(size, int)]
        if len(sizes) < len(dimensions) or prod(sizes) > ELEMENTS_MAX:
            made.append(Column(prefix + name, kind, tuple(dimensions)))
            continue
        for places in product(*map(range, sizes)):
            path = ".".join([prefix + name, *map(str, places)])
            made += columns_of(type_named(kind), f"{path}.") if "." in kind else [Column(path, kind)]
    return made


def _getter(name: str) -> Callable[[Any], Any]:
    """Returns the function that takes the value at a path from a message."""
    first, *steps = re.split(r"\.(?=\d)", name)  # each step begins with an index: `0`, or `0.x_m`
    base = attrgetter(first)
    if not steps:
        return base
    rest = [(int(index), attrgetter(path) if path else None) for index, _, path in (s.partition(".") for s in steps)]

    def get(message: Any) -> Any:
        value = base(message)
        for index, attributes in rest:
            value = value[index] if attributes is None else attributes(value[index])
        return value

    return get

"""Puts the values of a robot into the texts of its template: `{namespace}`, `{team}`."""

import re
from collections.abc import Callable, Mapping
from typing import Any

from fwk.plan.errors import hint
from fwk.plan.source import Node

_MARK = re.compile(r"\{([A-Za-z_]\w*)\}")


def substitute(node: Node, values: Mapping[str, Any], report: Callable[[str, str], None]) -> Node:
    """The same tree with every `{key}` in its texts replaced.

    A text that is nothing but `{key}` takes the value as it is, so that numbers stay numbers. An unknown key goes to
    `report` as place and text.
    """
    if isinstance(node.value, dict):
        return Node({key: substitute(below, values, report) for key, below in node.value.items()}, node.place)
    if isinstance(node.value, list):
        return Node([substitute(below, values, report) for below in node.value], node.place)
    if not isinstance(node.value, str) or "{" not in node.value:
        return node
    for key in _MARK.findall(node.value):
        if key not in values:
            report(node.place, f"nothing says what '{{{key}}}' in '{node.value}' stands for; {hint(key, values)}")
            return node
    whole = _MARK.fullmatch(node.value)
    if whole:
        return Node(values[whole[1]], node.place)
    return Node(_MARK.sub(lambda found: str(values[found[1]]), node.value), node.place)

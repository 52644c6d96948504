"""Replaces `{namespace}`, `{team}` and other keys in the texts of templates."""

import re
from collections.abc import Callable, Mapping
from typing import Any

from fwk.model.errors import hint
from fwk.plan.files.source import Node

_MARK = re.compile(r"\{([A-Za-z_]\w*)\}")


def substitute(node: Node, values: Mapping[str, Any], report: Callable[[str, str], None]) -> Node | None:
    """Returns the tree with every `{key}` in its texts replaced.

    A text with an unknown key is reported as place and message, and left out.
    """
    if isinstance(node.value, dict):
        found = {key: substitute(below, values, report) for key, below in node.value.items()}
        return Node({key: below for key, below in found.items() if below}, node.place)
    if isinstance(node.value, list):
        items = [substitute(below, values, report) for below in node.value]
        return Node([below for below in items if below], node.place)
    if not isinstance(node.value, str) or "{" not in node.value:
        return node
    for key in _MARK.findall(node.value):
        if key not in values:
            report(node.place, f"'{{{key}}}' in '{node.value}' has no value; {hint(key, values)}")
            return None
    return Node(_MARK.sub(lambda found: str(values[found[1]]), node.value), node.place)

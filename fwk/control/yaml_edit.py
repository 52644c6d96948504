"""Sets or removes one value in a YAML text and leaves all other characters unchanged, including comments."""

import json
import math
import re
from collections.abc import Sequence
from typing import Any

import yaml

from fwk.model.errors import Problems
from fwk.plan.files.source import read_value

_COMMA = re.compile(r"\s*,\s*")
_PLAIN_KEY = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_PLAIN_TEXT = re.compile(r"[A-Za-z_][\w./:-]*\w", re.ASCII)


class EditError(Exception):
    """The text cannot be changed without touching other values; the text of the error says why."""


def with_value(text: str, path: Sequence[str], value: Any) -> str:
    """Returns the text with `value` at the mapping keys of `path`, which are added if missing.

    The result is read again and compared, so that a text with aliases, for example, is refused and not damaged.

    Raises:
        EditError: the text is not YAML, or the value cannot be put there.
    """
    before = read(text)
    changed = _edited(text if text.strip() else "", path, value)
    if not _reads_as(changed, _over(before, path, value)):
        raise EditError(f"'{'.'.join(path)}' cannot be changed there without touching other values; edit it manually")
    return changed


def without(text: str, path: Sequence[str]) -> str:
    """Returns the text without the value at the mapping keys of `path`, and without keys that are then empty.

    Raises:
        EditError: the text is not YAML, has no such value, or the value cannot be removed without touching others.
    """
    data = read(text)
    depth, below = 0, data
    for place, key in enumerate(path):
        if not isinstance(below, dict) or key not in below:
            raise EditError(f"there is no '{'.'.join(path)}'")
        depth = place if len(below) > 1 else depth
        below = below[key]
    changed = _cut(text, path[: depth + 1])
    if not _reads_as(changed, _less(data, path[: depth + 1])):
        raise EditError(f"'{'.'.join(path)}' cannot be removed without touching other values; edit it manually")
    return changed


def read(text: str) -> Any:
    """Returns the text as plain data; an empty text is an empty mapping.

    Raises:
        EditError: the text is not YAML.
    """
    problems = Problems()
    node = read_value(text, "", problems)
    if problems or node is None:
        raise EditError("the text is not YAML; correct it first: fwk check names the place")
    return node.plain() or {}


def _reads_as(text: str, expected: Any) -> bool:
    try:
        return bool(read(text) == expected)
    except EditError:
        return False


def _over(data: Any, path: Sequence[str], value: Any) -> Any:
    if not path:
        return value
    below = data if isinstance(data, dict) else {}
    return {**below, path[0]: _over(below.get(path[0]), path[1:], value)}


def _less(data: Any, path: Sequence[str]) -> Any:
    return {
        key: _less(below, path[1:]) if key == path[0] else below
        for key, below in data.items()
        if path != [key] and path != (key,)
    }


def _cut(text: str, path: Sequence[str]) -> str:
    """Returns the text without the pair at `path`, which exists."""
    around: Any = None
    name: Any = None
    node: Any = yaml.compose(text, yaml.SafeLoader)
    for key in path:
        around = node
        name, node = next(pair for pair in around.value if pair[0].value == key)
    start, end = name.start_mark.index, _end(node)
    if around.flow_style:
        comma = _COMMA.match(text, end)
        before = text[:start] if comma else text[:start].rstrip().removesuffix(",")
        return before + text[comma.end() if comma else end :]
    if not text[:end].endswith("\n"):  # with the comment at the end of that line
        end = text.find("\n", end) + 1 or len(text)
    return text[: text.rfind("\n", 0, start) + 1] + text[end:]


def _edited(text: str, path: Sequence[str], value: Any) -> str:
    node = yaml.compose(text, yaml.SafeLoader)
    if node is None:
        return _with_newline(text) + _lines(path, value, 0)
    for depth, key in enumerate(path):
        if not isinstance(node, yaml.MappingNode):
            return _replaced(text, node, _nested(path[depth:], value))
        below = next((each for name, each in node.value if name.value == key), None)
        if below is None:
            return _inserted(text, node, path[depth:], value)
        node = below
    return _replaced(text, node, value)


def _replaced(text: str, node: yaml.Node, value: Any) -> str:
    start, end = node.start_mark.index, _end(node)
    gap = " " if start == end else ""  # a key without a value
    if isinstance(node, yaml.CollectionNode) and not node.flow_style:
        gap = "  "  # a list may have the indentation of its key, a value on one line may not
    newline = "\n" if text[start:end].endswith("\n") else ""
    return f"{text[:start]}{gap}{flow(value)}{newline}{text[end:]}"


def _inserted(text: str, node: yaml.MappingNode, path: Sequence[str], value: Any) -> str:
    if node.flow_style or not node.value:
        end = node.end_mark.index - 1
        pair = f"{_key(path[0])}: {flow(_nested(path[1:], value))}"
        return f"{text[:end]}{', ' if node.value else ''}{pair}{text[end:]}"
    end = _end(node)
    if not text[:end].endswith("\n"):  # after a comment at the end of that line
        end = text.find("\n", end) + 1 or len(text)
    return _with_newline(text[:end]) + _lines(path, value, node.value[0][0].start_mark.column) + text[end:]


def _end(node: yaml.Node) -> int:
    """Returns where a value ends; the parser counts what follows a block as part of it."""
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        return _end(last[1] if isinstance(last, tuple) else last)
    end: int = node.end_mark.index
    return end


def _lines(path: Sequence[str], value: Any, indent: int) -> str:
    made = [f"{' ' * (indent + 2 * depth)}{_key(key)}:" for depth, key in enumerate(path)]
    return "\n".join(made) + f" {flow(value)}\n"


def _nested(path: Sequence[str], value: Any) -> Any:
    for key in reversed(path):
        value = {key: value}
    return value


def _with_newline(text: str) -> str:
    return text if not text or text.endswith("\n") else f"{text}\n"


def _key(key: str) -> str:
    return key if _PLAIN_KEY.fullmatch(key) else json.dumps(key, ensure_ascii=False)


def flow(value: Any) -> str:
    """Returns a value as YAML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(str(key))}: {flow(below)}" for key, below in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return {math.inf: ".inf", -math.inf: "-.inf"}.get(value, ".nan")
    if isinstance(value, str) and _PLAIN_TEXT.fullmatch(value) and yaml.safe_load(value) == value:
        return value
    return json.dumps(value, ensure_ascii=False)

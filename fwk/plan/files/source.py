"""Reads YAML into nodes that know their file and line."""

import errno
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from fwk.model.errors import Problems

_SHOWN_MAX = 60
"""Number of characters that a message shows of a value."""
_HALF = re.compile(r"[\ud800-\udfff]")
"""Half of a letter that UTF-16 writes as a pair; no file and no message can hold it."""
_HALF_MISTAKE = "has half of a letter, written as \\ud800 to \\udfff; write the whole letter"
VALUES_MAX = 100_000
"""Largest number of values of a file with its aliases expanded; more is a mistake or an attack."""
FLOW_DEPTH_MAX = 100
"""Most brackets inside one another; the reader's time grows with the square of their number."""
BYTES_MAX = 1_000_000
"""Largest size of a file; reading it takes some seconds."""


@dataclass(frozen=True, slots=True)
class Node:
    """A value and its place; the value of a mapping or list is made of nodes."""

    value: Any
    place: str
    """`launch/robot.yaml:41`; of a mapping's value, the line of its key."""

    def plain(self) -> Any:
        """Returns the value as plain dicts, lists and scalars."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        return [node.plain() for node in self.value] if isinstance(self.value, list) else self.value

    def child(self, key: str | int) -> "Node | None":
        """Returns the node below a key or list position; None if there is none."""
        if isinstance(self.value, dict):
            return self.value.get(str(key))
        if isinstance(self.value, list) and isinstance(key, int) and key < len(self.value):
            node: Node = self.value[key]
            return node
        return None

    def at(self, *path: str | int) -> "Node":
        """Returns the node at a path, or the last node on the path that exists."""
        node = self
        for key in path:
            below = node.child(key)
            if below is None:
                return node
            node = below
        return node


class _Loader(yaml.SafeLoader):
    """YAML 1.2's plain values: `on` and `12:30` are text, `1e-3` is a number, `010` is ten."""

    yaml_implicit_resolvers = {}

    def fetch_flow_collection_start(self, TokenClass: Any) -> None:  # noqa: N803 - the library's name
        if self.flow_level >= FLOW_DEPTH_MAX:
            raise _TooDeepError
        super().fetch_flow_collection_start(TokenClass)


_TAG = "tag:yaml.org,2002:"
for _kind, _pattern in {
    "null": r"~|null|Null|NULL|",
    "bool": r"true|True|TRUE|false|False|FALSE",
    "int": r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+",
    "float": r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)",
}.items():
    _Loader.add_implicit_resolver(_TAG + _kind, re.compile(f"(?:{_pattern})$"), None)


def read_yaml(path: Path, shown: str, problems: Problems) -> Node | None:
    """Reads a file; `shown` is its name in places. Returns None after a mistake, which is added to `problems`."""
    data = b""
    try:
        data = _read(path)
        text = data.decode()
    except OSError as error:
        problems.add(shown, "", f"cannot be read: {error.strerror}")
        return None
    except UnicodeDecodeError as error:
        problems.add(f"{shown}:{data[: error.start].count(10) + 1}", "", "this is not UTF-8 text")
        return None
    if len(data) > BYTES_MAX:
        text = f"more than {BYTES_MAX:,} bytes are too many for a launch file; split the system, or use templates"
        problems.add(shown, "", text)
        return None
    return read_text(text, shown, problems)


def _read(path: Path) -> bytes:
    """Returns the bytes of a file, at most one more than allowed; never waits for a device such as /proc/kmsg."""
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with open(descriptor, "rb") as file:
        data = file.read(BYTES_MAX + 1)
    if data is None:  # a device or a pipe without data now
        raise OSError(errno.EAGAIN, "it is not an ordinary file")
    return data


def read_value(text: str, place: str, problems: Problems) -> Node | None:
    """Reads the value of `--set PATH=VALUE`."""
    if not text.strip():
        return Node("", place)
    scratch = Problems()
    node = read_text(text, place, scratch)
    if scratch:
        said = text if len(text) <= _SHOWN_MAX else f"{text[:_SHOWN_MAX]}..."
        problems.add(place, "", f"{said!r} is not a YAML value; write a number, true, false, text, [a, b] or {{a: 1}}")
        return None
    return _replaced(node, place) if node else Node(None, place)


def _replaced(node: Node, place: str) -> Node:
    if isinstance(node.value, dict):
        return Node({key: _replaced(below, place) for key, below in node.value.items()}, place)
    if isinstance(node.value, list):
        return Node([_replaced(below, place) for below in node.value], place)
    return Node(node.value, place)


def read_text(text: str, shown: str, problems: Problems) -> Node | None:
    """Reads a text; `shown` is its name in places. Returns None after a mistake, which is added to `problems`."""
    loader = None
    try:
        loader = _Loader(text)
        root = loader.get_single_node()
        if root and "*" in text and _count(root, {}) > VALUES_MAX:  # before they are written out
            raise _TooManyValuesError
        return _Converter(shown, problems).convert(root, 1) if root else Node({}, f"{shown}:1")
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        start = f"{error.context} that begins in line {error.context_mark.line + 1}, " if error.context_mark else ""
        reason = f"{start}{error.problem}"
        problems.add(f"{shown}:{mark.line + 1 if mark else 1}", "", f"this is not valid YAML: {reason}")
    except yaml.reader.ReaderError as error:
        line = text[: error.position].count("\n") + 1
        problems.add(
            f"{shown}:{line}", "", f"this is not valid YAML: character {chr(error.character)!r} is not allowed"
        )
    except (RecursionError, _TooDeepError):
        problems.add(f"{shown}:1", "", "values are nested too deeply; use a few levels")
    except _TooManyValuesError:
        problems.add(f"{shown}:1", "", f"more than {VALUES_MAX} values when its aliases are written out; use fewer")
    finally:
        if loader:
            loader.dispose()
    return None


def _count(node: yaml.Node, counted: dict[yaml.Node, int]) -> int:
    """Returns the number of values of a node with its aliases written out; `counted` are those of nodes so far."""
    if node not in counted:
        counted[node] = 1  # also where it contains itself
        if isinstance(node, yaml.CollectionNode):
            parts = [each[1] for each in node.value] if isinstance(node, yaml.MappingNode) else node.value
            counted[node] += sum(_count(each, counted) for each in parts)
    return counted[node]


class _TooDeepError(Exception):
    pass


class _TooManyValuesError(Exception):
    pass


class _Converter:
    def __init__(self, shown: str, problems: Problems) -> None:
        self._shown = shown
        self._problems = problems
        self._around: list[yaml.Node] = []
        self._values = 0

    def convert(self, node: yaml.Node, line: int) -> Node:
        """Converts a YAML node whose key is in `line`."""
        place = f"{self._shown}:{line}"
        self._values += 1
        if self._values > VALUES_MAX:
            raise _TooManyValuesError
        if node in self._around:
            self._problems.add(place, "", "this value contains itself; write it out")
            return Node(None, place)
        self._around.append(node)
        try:
            if isinstance(node, yaml.MappingNode):
                return Node(self._mapping(node), place)
            if isinstance(node, yaml.SequenceNode):
                return Node([self.convert(item, item.start_mark.line + 1) for item in node.value], place)
            return Node(self._scalar(node, place), place)
        finally:
            self._around.pop()

    def _mapping(self, node: yaml.MappingNode) -> dict[str, Node]:
        made: dict[str, Node] = {}
        for key, value in node.value:
            line = key.start_mark.line + 1
            word = _joined(key.value) if isinstance(key, yaml.ScalarNode) else None
            if word is None:
                self._problems.add(f"{self._shown}:{line}", "", "a key is one word, not a list or a mapping")
            elif word in made:
                first = made[word].place.rpartition(":")[2]
                text = f"'{word}' occurs a second time, first in line {first}; keep one"
                self._problems.add(f"{self._shown}:{line}", "", text)
            else:
                made[word] = self.convert(value, line)
        return made

    def _scalar(self, node: yaml.Node, place: str) -> Any:
        kind, text = node.tag.removeprefix(_TAG), node.value
        if kind == "str":
            whole = _joined(text)
            if _HALF.search(whole):
                self._problems.add(place, "", f"{whole[:_SHOWN_MAX]!r} {_HALF_MISTAKE}")
            return whole
        if kind == "null":
            return None
        try:
            if kind == "bool":
                return {"true": True, "false": False}[text.lower()]
            if kind == "int":
                return int(text, {"0o": 8, "0x": 16}.get(text[:2], 10))
            if kind == "float":
                return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
        except (KeyError, ValueError):
            self._problems.add(place, "", f"'{text:.{_SHOWN_MAX}}' is not a valid {kind}")
            return None
        self._problems.add(place, "", f"unknown tag '{node.tag}'; leave it out")
        return None


def _joined(text: str) -> str:
    r"""Returns the text with JSON's surrogate pairs, `"\ud83e\udd16"`, joined to letters."""
    if not _HALF.search(text):
        return text
    try:
        return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le")
    except UnicodeDecodeError:  # a single surrogate, which is a mistake
        return text

"""Plain data (null, booleans, numbers, text, lists, mappings) as a list of core.value_t, as settings travel."""

from collections.abc import Sequence
from typing import Any

from lcmtypes.core import value_t

_INT64 = range(-(2**63), 2**63)
DEPTH_MAX = 100
"""Nesting that is read back."""


def value_messages(value: Any) -> list[value_t]:
    """Returns the tree of a plain value.

    Raises:
        TypeError: the value contains something that is not plain data.
    """
    made: list[value_t] = []
    _append(made, "", value)
    return made


def value_of(messages: Sequence[value_t]) -> Any:
    """Returns the plain value of a tree.

    Raises:
        ValueError: the list is not exactly one tree, or is nested deeper than `DEPTH_MAX`.
    """
    value, end = _read(messages, 0, 0)
    if end != len(messages):
        raise ValueError(f"{len(messages) - end} values after the end of their tree")
    return value


def _append(made: list[value_t], name: str, value: Any) -> None:
    message = value_t()
    message.name = name
    made.append(message)
    if value is None:
        message.kind = value_t.NOTHING
    elif isinstance(value, bool):
        message.kind, message.truth = value_t.BOOLEAN, value
    elif isinstance(value, int) and value in _INT64:
        message.kind, message.integer = value_t.INTEGER, value
    elif isinstance(value, int):
        message.kind, message.text = value_t.LONG_INTEGER, str(value)
    elif isinstance(value, float):
        message.kind, message.number = value_t.NUMBER, value
    elif isinstance(value, str):
        message.kind, message.text = value_t.TEXT, value
    elif isinstance(value, list | tuple):
        message.kind, message.members = value_t.LIST, len(value)
        for each in value:
            _append(made, "", each)
    elif isinstance(value, dict):
        message.kind, message.members = value_t.MAP, len(value)
        for key, each in value.items():
            _append(made, str(key), each)
    else:
        raise TypeError(f"a {type(value).__name__} is not plain data")


def _read(messages: Sequence[value_t], place: int, depth: int) -> tuple[Any, int]:
    if place >= len(messages) or depth > DEPTH_MAX:
        raise ValueError("values end within their tree" if depth <= DEPTH_MAX else "values nested too deeply")
    message, after = messages[place], place + 1
    kind = message.kind
    if kind == value_t.NOTHING:
        return None, after
    if kind == value_t.BOOLEAN:
        return bool(message.truth), after
    if kind == value_t.INTEGER:
        return message.integer, after
    if kind == value_t.LONG_INTEGER:
        return int(message.text), after
    if kind == value_t.NUMBER:
        return message.number, after
    if kind == value_t.TEXT:
        return message.text, after
    if kind not in (value_t.LIST, value_t.MAP) or message.members < 0:
        raise ValueError(f"a value of the unknown kind {kind}, or with {message.members} members")
    listed, mapped = [], {}
    for _ in range(message.members):
        name = messages[after].name if after < len(messages) else ""
        value, after = _read(messages, after, depth + 1)
        listed.append(value)
        mapped[name] = value
    return (listed if kind == value_t.LIST else mapped), after

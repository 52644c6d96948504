"""Messages as JSON, and JSON schemas of their types.

Bytes are base64 text; numbers that JSON lacks are the texts `NaN`, `Infinity` and `-Infinity`, as in protobuf's JSON.
"""

import base64
import math
from typing import Any

from fwk.lcm import messages
from fwk.lcm.messages import Message, type_named

INTEGERS = ("int8_t", "int16_t", "int32_t", "int64_t", "byte")
FLOATS = ("float", "double")


def plain(message: Any) -> Any:
    """Returns a message as dicts, lists and values that JSON has."""
    if isinstance(message, float) and not math.isfinite(message):
        return "NaN" if math.isnan(message) else "Infinity" if message > 0 else "-Infinity"
    if isinstance(message, bytes | bytearray):
        return base64.b64encode(message).decode()
    if isinstance(message, list | tuple):
        return [plain(each) for each in message]
    if hasattr(message, "__typenames__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__}
    return message


def of_plain(message_type: type[Message], content: Any) -> Any:
    """Returns the message that `plain` made JSON of.

    Raises:
        MessageError, TypeError, ValueError, AttributeError: the content is not that of the type.
    """
    return messages.of_dict(message_type, _members(message_type, content))


def json_schema(message_type: type[Message]) -> dict[str, Any]:
    """Returns the JSON schema of a type."""
    properties = {name: _schema(kind, dimensions) for name, kind, dimensions in members_of(message_type)}
    return {"title": messages.type_name(message_type), "type": "object", "properties": properties}


def members_of(message_type: type[Message]) -> list[tuple[str, str, list[int | str]]]:
    """Returns name, kind and dimensions of the members of a type; a nested type's kind is its full name."""
    rows = zip(message_type.__slots__, message_type.__typenames__, message_type.__dimensions__, strict=True)
    return [(name, kind.removeprefix("lcmtypes."), dimensions or []) for name, kind, dimensions in rows]


def _schema(kind: str, dimensions: list[int | str]) -> dict[str, Any]:
    if kind == "byte" and len(dimensions) == 1:
        return {"type": "string", "contentEncoding": "base64"}
    if dimensions:
        return {"type": "array", "items": _schema(kind, dimensions[1:])}
    if kind in INTEGERS:
        return {"type": "integer"}
    if kind in FLOATS:
        return {"type": "number"}
    if kind in ("boolean", "string"):
        return {"type": kind}
    return json_schema(type_named(kind))


def _members(message_type: type[Message], content: Any) -> dict[str, Any]:
    return {name: _value(kind, len(dimensions), content[name]) for name, kind, dimensions in members_of(message_type)}


def _value(kind: str, depth: int, content: Any) -> Any:
    if kind == "byte" and depth == 1:
        return base64.b64decode(content)
    if depth:
        return [_value(kind, depth - 1, each) for each in content]
    if kind in FLOATS:
        return float(content)
    if "." in kind:
        return _members(type_named(kind), content)
    return content

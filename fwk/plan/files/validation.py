"""Checks values of a file against a pydantic model and reports mistakes with their lines."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from fwk.model.errors import hint
from fwk.plan.files.source import Node

M = TypeVar("M", bound=BaseModel)
Path = tuple[str | int, ...]
Report = Callable[[Path, str, str], None]
"""Takes a mistake: path of the value, place, text."""

_KINDS = {
    **dict.fromkeys(
        ("dict_type", "model_type", "model_attributes_type", "dataclass_type"),
        "it should be a mapping with keys such as 'name: value'",
    ),
    **dict.fromkeys(("bool_type", "bool_parsing"), "it should be true or false"),
}
"""Corrections in the words of YAML, by pydantic's kind of mistake."""
_LISTS = ("list_type", "tuple_type", "set_type", "frozen_set_type")
_NUMBERS, _TEXTS = [1, 2], ["a", "b"]
_UNKNOWN_KEY = ("extra_forbidden", "unexpected_keyword_argument")


@dataclass(frozen=True)
class _Mistake:
    path: Path
    location: Path
    text: str
    missing: bool


def validated(model: type[M], node: Node, report: Report, what: str) -> tuple[M, Node] | None:
    """Returns the values as an instance of the model, and their node; every mistake goes to `report`.

    `what` is the word for a key. Values that do not fit are left out of both, so that the rest can be checked. None if
    nothing is left.
    """
    first = True
    left_out: set[Path] = set()  # what takes the place of these values, such as a default, is not in the file
    shortened: list[Path] = []  # lists that lost a value: what comes after it has moved
    while True:
        made, mistakes = _tried(model, node, what)
        for mistake in mistakes:
            moved = any(mistake.path[: len(path)] == path for path in shortened)
            replaced = mistake.location in left_out
            if first or not (mistake.missing or moved or replaced):  # missing values may have been left out here
                report(mistake.path, node.at(*mistake.path).place, mistake.text)
        if made:
            return made, node
        if any(mistake.path == () for mistake in mistakes):
            return None
        for path in reversed(
            dict.fromkeys(mistake.path for mistake in mistakes)
        ):  # from the end, to keep positions in lists valid
            node = _without(node, path)
            left_out.add(path)
            if isinstance(path[-1], int):
                shortened.append(path[:-1])
        first = False


def _tried(model: type[M], node: Node, what: str) -> tuple[M | None, list[_Mistake]]:
    try:
        made = model.model_validate(node.plain())
    except ValidationError as error:
        return None, [
            _Mistake(
                _path(node, found["loc"]), found["loc"], _text(model, node, found, what), found["type"] == "missing"
            )
            for found in error.errors(include_url=False)
        ]
    mixed_up = [_Mistake(path, path, text, False) for path, text in _mixed_up(made.model_dump(), node, ())]
    return None if mixed_up else made, mixed_up


def _without(node: Node, path: Path) -> Node:
    below = node.child(path[0])
    if below is None:
        return node
    kept = _without(below, path[1:]) if len(path) > 1 else None
    if isinstance(node.value, dict):
        return Node(
            {key: kept if each is below else each for key, each in node.value.items() if kept or each is not below},
            node.place,
        )
    return Node([kept if each is below else each for each in node.value if kept or each is not below], node.place)


def _path(node: Node, location: Path) -> Path:
    """Returns the part of an error's location that is in the file; pydantic adds names of union members."""
    path: Path = ()
    for key in location:
        if node.at(*path).child(key) is None:
            break
        path = (*path, key)
    return path


def _text(model: type[BaseModel], node: Node, details: ErrorDetails, what: str) -> str:
    location, kind = details["loc"], details["type"]
    if kind in _UNKNOWN_KEY:
        return f"no {what} '{_dotted(location)}'; {hint(str(location[-1]), _fields_at(model, location[:-1]))}"
    if kind == "missing" and isinstance(location[-1], int):
        return f"'{_dotted(location[:-1])}' is {_short(node.at(*location[:-1]).plain())}; it should be longer"
    if kind == "missing":
        return f"the {what} '{_dotted(location)}' is missing; it has no default"
    if kind == "too_long":
        most, given = details["ctx"]["max_length"], _short(node.at(*location).plain())
        return f"'{_dotted(location)}' is {given}; it should have at most {most} values"
    message = _KINDS.get(kind) or details["msg"].removeprefix("Value error, ").replace("Input should", "it should")
    path = _path(node, location)
    if not path:
        return f"the default of '{_dotted(location)}' does not fit: {message}" if location else message
    if kind in _LISTS:
        message = f"it should be a list such as {_list_instead(model, node, path, location)}"
    if node.at(*path).value is None:
        return f"'{_dotted(path)}' is empty; {message}"
    return f"'{_dotted(path)}' is {_short(node.at(*path).plain())}; {message}"


def _list_instead(model: type[BaseModel], node: Node, path: Path, location: Path) -> str:
    """Returns a list that fits in the place of another value: that with this value alone, or one of a usual kind."""
    values = node.plain()
    within = values
    for key in path[:-1]:
        within = within[key]
    given = within[path[-1]]
    for candidate in ([given], _NUMBERS, _TEXTS):
        within[path[-1]] = candidate
        try:
            model.model_validate(values)
        except ValidationError as error:
            if any(found["loc"][: len(location)] == location for found in error.errors(include_url=False)):
                continue
        return _short(candidate)
    return _short([given] if isinstance(given, dict) else _NUMBERS)


def _mixed_up(made: Any, node: Node, path: Path) -> list[tuple[Path, str]]:
    """Returns truth values that became numbers and vice versa, which pydantic accepts but authors do not mean."""
    if isinstance(node.value, dict) and isinstance(made, dict):
        pairs = [(key, made.get(key), below) for key, below in node.value.items()]
        return [found for key, value, below in pairs for found in _mixed_up(value, below, (*path, key))]
    given = node.value
    if not isinstance(given, bool | int | float) or not isinstance(made, bool | int | float):
        return []
    if isinstance(given, bool) == isinstance(made, bool):
        return []
    right = "true or false" if isinstance(made, bool) else "a number"
    return [(path, f"'{_dotted(path)}' is {_short(given)}; it should be {right}")]


def _fields_at(model: type[BaseModel], location: Path) -> list[str]:
    """Returns the fields of the model at a location, through optional fields, lists and mappings."""
    kind: Any = model
    for key in location:
        fields = _fields(kind)
        if not fields:
            kind = get_args(kind)[-1] if get_args(kind) else None
        elif key in fields:
            kind = fields[str(key)]
        elif key != kind.__name__:  # locations contain the names of union members, too
            return []
        kind = _unwrapped(kind)
    return list(_fields(kind))


def _fields(kind: Any) -> dict[str, Any]:
    """Returns the fields of a model or dataclass with their types; of any other type none."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return {name: field.annotation for name, field in kind.model_fields.items()}
    return {each.name: each.type for each in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else {}


def _unwrapped(kind: Any) -> Any:
    """Returns the part of an annotated or optional type that can have fields."""
    while get_origin(kind) in (Union, UnionType, Annotated):
        kind = next((each for each in get_args(kind) if each is not NoneType), None)
    return kind


def _dotted(path: Path) -> str:
    return ".".join(map(str, path))


def _short(value: Any) -> str:
    words = {True: "true", False: "false"}
    text = words[value] if isinstance(value, bool) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."

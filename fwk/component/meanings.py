"""Meanings of settings: the docstrings below the fields of a class, read when they are asked for."""

import ast
import inspect
from collections.abc import Mapping
from functools import cache
from itertools import pairwise
from textwrap import dedent
from typing import Any

from pydantic.json_schema import GenerateJsonSchema


@cache
def meanings_of(kind: type) -> Mapping[str, str]:
    """Returns the docstring below each field of a class and of its bases; no entry for a field without."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        if inspect.get_annotations(base):
            found |= _own(base)
    return found


def _own(kind: type) -> dict[str, str]:
    try:
        tree = ast.parse(dedent(inspect.getsource(kind)))
    except (OSError, TypeError, SyntaxError):  # made at run time, or without its file
        return {}
    found = {}
    for field, text in pairwise(tree.body[0].body if isinstance(tree.body[0], ast.ClassDef) else ()):
        match field, text:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(meaning))):
                found[name] = inspect.cleandoc(meaning)
    return found


class DocumentedSchema(GenerateJsonSchema):
    """Generator of JSON Schema that describes each field of a class by the docstring below it.

    Pydantic can do so itself, but it then reads the source of each class while the class is made: at every start.
    """

    def model_schema(self, schema: Any) -> dict[str, Any]:
        """Generates the schema of a pydantic model."""
        return _described(super().model_schema(schema), schema["cls"])

    def dataclass_schema(self, schema: Any) -> dict[str, Any]:
        """Generates the schema of a dataclass."""
        return _described(super().dataclass_schema(schema), schema["cls"])


def _described(made: dict[str, Any], kind: type) -> dict[str, Any]:
    for name, meaning in meanings_of(kind).items():
        if name in made.get("properties", {}):
            made["properties"][name].setdefault("description", meaning)
    return made

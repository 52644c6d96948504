"""Conditions over the messages of a run: `robot.odometry.x_m >= 1 and abs(robot.odometry.y_m) < 0.5`."""

import ast
from collections.abc import Callable, Mapping
from typing import Any

from fwk.testing.bounded import BOUNDED, Bounding

Words = Mapping[str, Callable[..., Any]]
"""Functions that conditions may call, by name."""

_PLAIN: Words = {"abs": abs, "len": len, "max": max, "min": min, "sorted": sorted}
_ALLOWED = (
    ast.Expression,
    ast.BoolOp,
    ast.BinOp,
    ast.UnaryOp,
    ast.Compare,
    ast.Call,
    ast.Attribute,
    ast.Subscript,
    ast.Name,
    ast.Constant,
    ast.List,
    ast.Tuple,
    ast.boolop,
    ast.operator,
    ast.unaryop,
    ast.cmpop,
    ast.expr_context,
)


class ExpressionError(ValueError):
    """A condition that cannot be understood."""


class Namespace:
    """Newest messages of a namespace: `robot.odometry` is the newest message of the channel `robot/odometry`."""

    def __init__(self, name: str, newest: Callable[[str], Any]) -> None:
        self._name, self._newest = name, newest

    def __getattr__(self, interface: str) -> Any:
        return self._newest(f"{self._name}/{interface}")

    def __str__(self) -> str:
        return self._name


class Expression:
    """A condition in Python's syntax; it calls nothing but the given words and reads nothing but messages."""

    def __init__(self, text: str, words: Words | None = None) -> None:
        """Checks the text.

        Raises:
            ExpressionError: the text is not a condition, or it calls an unknown word.
        """
        self.text = text
        self._words = {**_PLAIN, **(words or {})}
        try:
            tree = ast.parse(text.strip(), mode="eval")
        except SyntaxError as error:
            raise ExpressionError(f"'{text}': {error.msg}") from error
        except (ValueError, RecursionError, MemoryError) as error:  # bytes that are no text; a hundred brackets
            raise ExpressionError(f"'{text:.60}': cannot be read; write it shorter ({error})") from error
        for node in ast.walk(tree):
            self._check(node)
        called = {node.func for node in ast.walk(tree) if isinstance(node, ast.Call)}
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and node not in called}
        self._namespaces = sorted(names - set(self._words))
        self._code = compile(Bounding().visit(tree), "<condition>", "eval")

    def value(self, newest: Callable[[str], Any]) -> Any:
        """Returns the value; `newest` gives the newest message of a channel.

        Raises:
            ExpressionError: a channel or a field does not exist, or the values do not fit together.
        """
        known: dict[str, Any] = {name: _bound(word, newest) for name, word in self._words.items()}
        known |= {name: Namespace(name, newest) for name in self._namespaces}
        known |= BOUNDED
        try:
            return eval(self._code, {"__builtins__": {}}, known)
        except (AttributeError, KeyError, IndexError, TypeError, ValueError, ArithmeticError) as error:
            raise ExpressionError(f"'{self.text}': {type(error).__name__}: {error}") from error

    def _check(self, node: ast.AST) -> None:
        if not isinstance(node, (*_ALLOWED, ast.Load)):
            raise ExpressionError(f"'{self.text}': {type(node).__name__} is not allowed in a condition")
        if isinstance(node, ast.Attribute) and node.attr.startswith("_"):
            raise ExpressionError(f"'{self.text}': '{node.attr}' begins with an underscore")
        if isinstance(node, ast.Call) and (not isinstance(node.func, ast.Name) or node.func.id not in self._words):
            raise ExpressionError(f"'{self.text}': calls only {', '.join(sorted(self._words))}")


def _bound(word: Callable[..., Any], newest: Callable[[str], Any]) -> Any:
    """Returns a word, or its value for this moment if the word is marked as one that reads messages."""
    if getattr(word, "reads_messages", False):
        return word(newest)
    return word


def reads_messages(word: Callable[..., Any]) -> Callable[..., Any]:
    """Marks a word that is given `newest` first: its value, or a function, then stands for it in conditions."""
    word.reads_messages = True  # type: ignore[attr-defined]
    return word

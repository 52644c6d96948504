"""Conditions over the messages of a run: `robot.odometry.x_m >= 1 and abs(robot.odometry.y_m) < 0.5`."""

import ast
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from fwk.model.errors import hint
from fwk.testing.bounded import BOUNDED, Bounding
from fwk.testing.misfits import Misfits, always_holds

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
_IDENTITIES: Mapping[type[ast.cmpop], tuple[str, str]] = {ast.Is: ("is", "=="), ast.IsNot: ("is not", "!=")}
"""Comparisons that do not look at values, and those that do."""


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

    def __init__(self, text: str, words: Words | None = None, place: str = "") -> None:
        """Checks the text.

        Args:
            text: the condition.
            words: functions that it may call.
            place: its file and line, for the errors.

        Raises:
            ExpressionError: the text is not a condition, or it has an unknown word.
        """
        self.text = text
        self._name = f"{place}: '{text}'" if place else f"'{text}'"
        if not text.strip():
            raise ExpressionError("an empty condition; write such as robot.odometry.x_m >= 1")
        self._words = {**_PLAIN, **(words or {})}
        try:
            tree = ast.parse(text.strip(), mode="eval")
        except SyntaxError as error:
            cure = "; join comparisons such as a.b == 1 with and, or, not" if error.msg == "invalid syntax" else ""
            raise ExpressionError(f"{self._name}: {error.msg}{cure}") from error
        except (ValueError, RecursionError, MemoryError) as error:  # bytes that are no text; a hundred brackets
            raise _unreadable(text, error) from error
        for node in ast.walk(tree):
            self._check(node)
        self._reads = any(isinstance(node, ast.Name) for node in ast.walk(tree))
        names = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id not in self._words]
        self._namespaces = sorted({node.id for node in names})
        used, compared = _namespaces_in(tree), _compared_in(tree)
        for node in names:
            if node not in used:
                right = hint(node.id, self._words)
                quotes = "; a text needs quotes" if node in compared and right.startswith("there") else ""
                raise ExpressionError(f"{self._name}: there is no '{node.id}'; {right}{quotes}")
        self._names_known = False
        try:
            self._tree = Bounding().visit(tree)
            self._code = compile(self._tree, "<condition>", "eval")
        except (RecursionError, MemoryError) as error:
            raise _unreadable(text, error) from error

    def value(self, newest: Callable[[str], Any]) -> Any:
        """Returns the value; `newest` gives the newest message of a channel.

        The first call looks for unknown names everywhere, also where `and` or `or` need not look.

        Raises:
            ExpressionError: a channel or a field does not exist, or the values do not fit together.
        """
        known: dict[str, Any] = {name: _bound(word, newest) for name, word in self._words.items()}
        known |= {name: Namespace(name, newest) for name in self._namespaces}
        known |= BOUNDED
        try:
            if not self._names_known:
                self._check_parts(self._tree.body, known)
                self._names_known = True
            return eval(self._code, {"__builtins__": {}}, known)
        except (AttributeError, KeyError, IndexError, TypeError, ValueError, ArithmeticError, RecursionError) as error:
            raise ExpressionError(f"{self._name}: {_said(error)}") from error

    def holds(self, newest: Callable[[str], Any]) -> bool:
        """Returns whether the condition holds; see `value`.

        Raises:
            ExpressionError: besides, the value is of a kind that says nothing, such as a function or a message.
        """
        value = self.value(newest)
        if not self._reads:
            raise ExpressionError(f"{self._name}: a fixed value is no condition; compare something with it")
        wrong = always_holds(self.text.strip(), value)
        if wrong:
            raise ExpressionError(f"{self._name}: {wrong}")
        return bool(value)

    def _check_parts(self, part: ast.expr, known: Mapping[str, Any]) -> None:
        """Evaluates all parts of a condition, the innermost first; passes over errors that other values may not cause.

        Raises:
            TypeError: the values of a part do not fit together.
        """
        for inner in ast.iter_child_nodes(part):
            if isinstance(inner, ast.expr):
                self._check_parts(inner, known)

        def values(node: ast.expr) -> Any:
            whole = ast.fix_missing_locations(ast.Expression(node))
            return eval(compile(whole, "<condition>", "eval"), {"__builtins__": {}}, known)

        misfits = Misfits(self.text.strip(), values)
        with suppress(IndexError, ValueError, ArithmeticError):
            try:
                values(part)
            except TypeError as error:
                raise TypeError(misfits.words(part) or str(error)) from error
            wrong = misfits.never_equal(part) if isinstance(part, ast.Compare) else misfits.no_condition(part)
            if wrong:
                raise TypeError(wrong)

    def _check(self, node: ast.AST) -> None:
        if not isinstance(node, (*_ALLOWED, ast.Load)):
            raise ExpressionError(f"{self._name}: {type(node).__name__} is not allowed in a condition")
        if isinstance(node, ast.cmpop) and type(node) in _IDENTITIES:
            symbol, right = _IDENTITIES[type(node)]
            raise ExpressionError(f"{self._name}: '{symbol}' compares no values; write {right}")
        if isinstance(node, ast.Attribute) and node.attr.startswith("_"):
            raise ExpressionError(f"{self._name}: '{node.attr}' begins with an underscore")
        if isinstance(node, ast.Call) and (not isinstance(node.func, ast.Name) or node.func.id not in self._words):
            raise ExpressionError(f"{self._name}: calls only {', '.join(sorted(self._words))}")


def _unreadable(text: str, error: Exception) -> ExpressionError:
    """Says that Python cannot read a text, and why if Python says so."""
    why = f" ({error})" if str(error) else ""
    return ExpressionError(f"'{text:.60}': cannot be read; write it shorter{why}")


def _namespaces_in(tree: ast.AST) -> set[ast.expr]:
    """Returns the nodes that stand for namespaces: before a dot, or as an argument of a word that is not plain."""
    nodes = list(ast.walk(tree))
    calls = [node for node in nodes if isinstance(node, ast.Call)]
    arguments = (each for call in calls if getattr(call.func, "id", "") not in _PLAIN for each in call.args)
    return {*(node.value for node in nodes if isinstance(node, ast.Attribute)), *arguments}


def _compared_in(tree: ast.Expression) -> set[ast.expr]:
    """Returns the two sides of all comparisons."""
    return {side for node in ast.walk(tree) if isinstance(node, ast.Compare) for side in (node.left, *node.comparators)}


def _said(error: Exception) -> str:
    if isinstance(error, AttributeError) and error.name:
        known = [name for name in dir(error.obj) if name.islower() and not name.startswith("_")]
        fields = [name for name in known if not callable(getattr(error.obj, name))]
        return f"{type(error.obj).__name__} has no '{error.name}'; {hint(error.name, fields)}"
    if isinstance(error, KeyError) and error.args:
        text = str(error.args[0])
        return text if " " in text else f"there is no '{text}'"
    if isinstance(error, IndexError):
        return "an index is beyond the end of its list; ask for its length before: len(...) > 0 and ..."
    if isinstance(error, ZeroDivisionError):
        return "it divides by zero; ask for the divisor before: ... != 0 and ..."
    return str(error)


def _bound(word: Callable[..., Any], newest: Callable[[str], Any]) -> Any:
    """Returns a word, or its value for this moment if the word is marked as one that reads messages."""
    if getattr(word, "reads_messages", False):
        return word(newest)
    return word


def reads_messages(word: Callable[..., Any]) -> Callable[..., Any]:
    """Marks a word that is given `newest` first: its value, or a function, then stands for it in conditions."""
    word.reads_messages = True  # type: ignore[attr-defined]
    return word

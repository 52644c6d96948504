"""Values that do not fit together in a condition, in words that say what would fit."""

import ast
import inspect
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any

_BINARY = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.RShift: ">>",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.BitXor: "^",
    ast.MatMult: "@",
}
_UNARY = {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"}
_ORDERS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
_EQUALS = {ast.Eq: "==", ast.NotEq: "!="}
_TAKES = {"abs": "a number", "len": "a list or a text", "max": "a list", "min": "a list", "sorted": "a list"}
"""Values that the plain words take."""

Values = Callable[[ast.expr], Any]
"""Gives the value of a part of the condition."""


class Misfits:
    """Finds words for a part of a condition that cannot be computed, although the parts inside it can."""

    def __init__(self, text: str, values: Values) -> None:
        self._text, self._values = text, values

    def words(self, part: ast.expr) -> str:
        """Returns what does not fit in a part that raised a `TypeError`; an empty text if only Python knows."""
        match part:
            case ast.Compare():
                return self._compared(part)
            case ast.Call(func=ast.Name() as word):
                return self._called(word, part.args)
            case ast.BinOp(op=operation) if type(operation) in _BINARY:
                return f"'{_BINARY[type(operation)]}' takes two numbers, but {self._wrong(part.left, part.right)}"
            case ast.UnaryOp(op=sign) if type(sign) in _UNARY:
                return f"'{_UNARY[type(sign)]}' takes a number, but {self._wrong(part.operand)}"
            case ast.Subscript():
                return self._indexed(part)
        return ""

    def never_equal(self, part: ast.Compare) -> str:
        """Returns which two values can never be equal, because they are of different kinds; empty if all can."""
        for left, operation, right in _pairs(part):
            one, two = self._values(left), self._values(right)
            tuples = isinstance(one, tuple) and isinstance(two, tuple)
            same = tuples or one is None or two is None or kind(one) == kind(two)
            if type(operation) in _EQUALS and not same:
                said = f"{self._said(left)} is {kind(one)} and {self._said(right)} is {kind(two)}"
                return f"'{_EQUALS[type(operation)]}' compares values of one kind, but {said}"
        return ""

    def no_condition(self, part: ast.expr) -> str:
        """Returns which part of an `and`, an `or` or a `not` always holds, and what would be right; or nothing."""
        parts: list[ast.expr] = []
        if isinstance(part, ast.BoolOp):
            parts = part.values
        elif isinstance(part, ast.UnaryOp) and isinstance(part.op, ast.Not):
            parts = [part.operand]
        found = (
            always_holds(self._said(each), value) for each in parts if always_holds("", value := self._values(each))
        )
        return next(found, "")

    def _compared(self, part: ast.Compare) -> str:
        for left, operation, right in _pairs(part):
            try:
                self._values(ast.Compare(left, [operation], [right]))
            except TypeError:
                order = _ORDERS.get(type(operation))
                if order:
                    return f"'{order}' compares two numbers, but {self._wrong(left, right)}"
                if isinstance(self._values(right), str):
                    return f"'in' looks for a text in {self._said(right)}, but {self._wrong(left, also_numbers=True)}"
                return f"'in' looks into a list or a text, but {self._wrong(right, also_numbers=True)}"
        return ""

    def _called(self, word: ast.Name, arguments: Sequence[ast.expr]) -> str:
        function = self._values(word)
        if not callable(function):
            return f"{word.id} is {kind(function)}, not a function; write it without brackets"
        try:
            inspect.signature(function).bind(*arguments)
        except TypeError:
            names = "" if word.id in _TAKES else f" ({', '.join(inspect.signature(function).parameters)})"
            return f"{word.id} takes {_number_taken(function)}{names}; here {_number(len(arguments))}"
        except ValueError:  # Python does not tell what it takes
            if not arguments:
                return f"{word.id} takes {_TAKES.get(word.id, 'values')}, or at least two numbers; here are none"
        if word.id not in _TAKES:
            return ""
        return f"{word.id} takes {_TAKES[word.id]}, but {self._wrong(*arguments, also_numbers=word.id != 'abs')}"

    def _indexed(self, part: ast.Subscript) -> str:
        value = self._values(part.value)
        if isinstance(value, (list, tuple, str)):
            return f"an index is a whole number, but {self._said(part.slice)} is {kind(self._values(part.slice))}"
        return f"{self._said(part.value)} is {kind(value)}, not a list; it has no [{self._said(part.slice)}]"

    def _wrong(self, *parts: ast.expr, also_numbers: bool = False) -> str:
        """Returns what the parts are that are no numbers, and how to get one from them."""
        named = [(self._said(part), self._values(part)) for part in parts]
        wrong = [(said, value) for said, value in named if also_numbers or not isinstance(value, Real)]
        return " and ".join(f"{said} is {kind(value)}{_way_out(said, value)}" for said, value in wrong or named)

    def _said(self, part: ast.expr) -> str:
        """Returns the part as the condition spells it."""
        return ast.get_source_segment(self._text, part) or ast.unparse(part)


def kind(value: Any) -> str:
    """Returns what a value is, in a reader's words."""
    if value is None:
        return "nothing"
    if isinstance(value, Real):
        return "a number"
    if isinstance(value, str):
        return "a text"
    if inspect.isroutine(value):
        return "a function"
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return "a list"
    return f"a {type(value).__name__}"


def always_holds(said: str, value: Any) -> str:
    """Returns that a value counts as true whatever it is, and what would be right; empty for one that tells."""
    right = _part_of(said, value, "compare")
    return f"{said} is {kind(value)}, which always holds; {right}" if right else ""


def fields_of(value: Any) -> list[str]:
    """Returns the fields of a message or a named tuple; other values have none."""
    if isinstance(value, tuple):
        return list(getattr(value, "_fields", ()))
    return [name for name in getattr(value, "__slots__", ()) if not name.startswith("_") and name != "header"]


def _pairs(part: ast.Compare) -> list[tuple[ast.expr, ast.cmpop, ast.expr]]:
    return list(zip([part.left, *part.comparators], part.ops, part.comparators, strict=False))


def _number_taken(function: Callable[..., Any]) -> str:
    """Returns how many values a function takes."""
    parameters = inspect.signature(function).parameters.values()
    least, most = sum(each.default is each.empty for each in parameters), len(parameters)
    number = f"{most}" if least == most else f"{least} or {most}"
    return f"{number} value{'s' if most > 1 else ''}"


def _number(given: int) -> str:
    return "is 1" if given == 1 else f"are {given or 'none'}"


def _way_out(said: str, value: Any) -> str:
    """Returns how a value becomes a number."""
    right = _part_of(said, value, "take")
    if not right and isinstance(value, list):
        right = f"its length is len({said})"
    return f"; {right}" if right else ""


def _part_of(said: str, value: Any, verb: str) -> str:
    """Returns how to get at what a message or a function has to say; empty for other values."""
    fields = fields_of(value)
    if fields:
        return f"{verb} one of its fields, such as {said}.{fields[0]}"
    return f"call it: {said}(...)" if inspect.isroutine(value) else ""

"""Operators of conditions whose results stay small: none takes long or fills the memory, whatever its operands are."""

import ast
from collections.abc import Callable, Mapping
from numbers import Real
from typing import Any

_BITS = 1024
"""Largest number of bits of a whole number; the greatest floats have as many."""


def _times(one: Any, two: Any) -> Any:
    _check_numbers("*", one, two)
    if isinstance(one, int) and isinstance(two, int):
        _check_bits("*", one.bit_length() + two.bit_length())
    return one * two


def _power(base: Any, exponent: Any) -> Any:
    _check_numbers("**", base, exponent)
    if isinstance(base, int) and isinstance(exponent, int):
        _check_bits("**", base.bit_length() * exponent)
    return base**exponent


def _shifted(number: Any, places: Any) -> Any:
    _check_numbers("<<", number, places)
    if isinstance(number, int) and isinstance(places, int):
        _check_bits("<<", number.bit_length() + places)
    return number << places


def _remainder(number: Any, divisor: Any) -> Any:
    _check_numbers("%", number, divisor)
    return number % divisor


BOUNDED: Mapping[str, Callable[[Any, Any], Any]] = {"*": _times, "**": _power, "<<": _shifted, "%": _remainder}
"""Functions that take the place of operators. No name in a condition can be spelt like them."""
_SYMBOLS: Mapping[type[ast.operator], str] = {ast.Mult: "*", ast.Pow: "**", ast.LShift: "<<", ast.Mod: "%"}


class Bounding(ast.NodeTransformer):
    """Puts calls of the bounded functions in the place of their operators."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """Returns a call for an operator that could explode, and any other operation as it is."""
        self.generic_visit(node)
        symbol = _SYMBOLS.get(type(node.op))
        if symbol is None:
            return node
        called = ast.Call(ast.Name(symbol, ast.Load()), [node.left, node.right], [])
        return ast.fix_missing_locations(ast.copy_location(called, node))


def _check_numbers(symbol: str, *operands: Any) -> None:
    for each in operands:
        if not isinstance(each, Real):
            raise TypeError(f"'{symbol}' takes numbers, not {type(each).__name__}")


def _check_bits(symbol: str, bits: int) -> None:
    if bits > _BITS:
        raise OverflowError(f"the result of '{symbol}' is too large; it may have {_BITS} bits")

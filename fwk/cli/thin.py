"""Commands that people type often, run without typer: their words are read by the index of commands."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

from fwk.cli.index import Command, Parameter, read

FUNCTIONS = {
    "status": "fwk.cli.look.show_status:show_status",
    "ps": "fwk.cli.look.show_runs:show_runs",
}
"""Command to the function that carries it out; its arguments are the command's parameters, it returns the exit code."""


class _UnreadableError(Exception):
    """The words contain something that only typer understands or explains."""


def prepared(words: list[str]) -> Callable[[], int] | None:
    """Returns the call of a thin command; None for other commands and for mistakes, which typer explains."""
    if words[0] not in FUNCTIONS:
        return None
    command = next(each for each in read() if each.words == ("fwk", words[0]))
    try:
        values = arguments(command, words[1:])
    except _UnreadableError:
        return None
    module, _, name = FUNCTIONS[words[0]].partition(":")

    def call() -> int:
        from fwk.control.client import ControlError, RefusedError
        from fwk.program import complain

        try:
            return int(getattr(import_module(module), name)(**values))
        except ControlError as error:
            complain(str(error))
            return 2 if isinstance(error, RefusedError) else 1

    return call


def arguments(command: Command, words: list[str]) -> dict[str, Any]:
    """Reads words into values by the names of the command's parameters.

    Raises:
        _UnreadableError: a word that the full parser has to judge.
    """
    values: dict[str, Any] = {each.name: _empty(each) for each in command.parameters}
    places = command.arguments
    left = list(words)
    while left:
        word = left.pop(0)
        if not word.startswith("-") or word == "-":
            if not places:
                raise _UnreadableError
            _keep(values, places[0], word)
            if not places[0].many:
                places = places[1:]
            continue
        name, equals, value = word.partition("=")
        option = command.option(name)
        if option is None or (option.flag and equals) or (not option.flag and not equals and not left):
            raise _UnreadableError
        _keep(values, option, True if option.flag else value if equals else left.pop(0))
    if any(each.required and not values[each.name] for each in command.arguments):
        raise _UnreadableError
    return values


def _empty(parameter: Parameter) -> Any:
    return [] if parameter.many else False if parameter.flag else None


def _keep(values: dict[str, Any], parameter: Parameter, value: Any) -> None:
    if parameter.kind not in ("text", "boolean") or parameter.choices:
        raise _UnreadableError
    if parameter.many:
        values[parameter.name].append(value)
    else:
        values[parameter.name] = value

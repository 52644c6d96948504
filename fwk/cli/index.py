"""Index of all commands: help, completion and the thin commands read it instead of importing the commands.

`make docs` writes it from the commands themselves, together with docs/commands.md.
"""

import json
import os
from typing import Any, NamedTuple

FILE = os.path.join(os.path.dirname(__file__), "index.json")


class Parameter(NamedTuple):
    """Argument or option of a command."""

    name: str
    """Name in Python."""
    options: tuple[str, ...]
    """Names of an option, such as `--json`; empty for an argument."""
    metavar: str
    flag: bool
    many: bool
    required: bool
    kind: str
    """Type of the value: `text`, `boolean`, or `other`, which only the command itself can judge."""
    choices: tuple[str, ...]


class Command(NamedTuple):
    """Command as it is typed, such as `fwk config list`, or a group of commands, such as `fwk config`."""

    words: tuple[str, ...]
    summary: str
    parameters: tuple[Parameter, ...]

    def option(self, name: str) -> Parameter | None:
        """Returns the option of that name."""
        return next((each for each in self.parameters if name in each.options), None)

    @property
    def arguments(self) -> list[Parameter]:
        """Returns all parameters without a name."""
        return [each for each in self.parameters if not each.options]


def read() -> list[Command]:
    """Returns all commands, in the order of the help."""
    with open(FILE, "rb") as file:
        rows = json.load(file)
    return [Command(tuple(row["words"]), row["summary"], tuple(map(_parameter, row["parameters"]))) for row in rows]


def _parameter(row: dict[str, Any]) -> Parameter:
    return Parameter(**{**row, "options": tuple(row["options"]), "choices": tuple(row["choices"])})


def subcommands(commands: list[Command], words: tuple[str, ...]) -> dict[str, str]:
    """Returns the words that may follow `words`, each with its summary."""
    found: dict[str, str] = {}
    for each in commands:
        if each.words[:-1] == words:
            found[each.words[-1]] = each.summary
    return found

"""Writes docs/commands.md and the index of commands from the commands: python -m fwk.cli.reference docs/commands.md."""

import json
import sys
from collections.abc import Iterator
from enum import Enum
from inspect import cleandoc
from pathlib import Path
from typing import Any, get_args, get_type_hints

import typer

from fwk.cli import commands as commands_of_fwk
from fwk.cli.examples import EXAMPLES
from fwk.cli.index import FILE as INDEX
from fwk.cli.run import launch_command

_HEAD = """\
# Commands

`make docs` writes this page from the commands themselves; `--help` prints the same. `fwk --version` prints the version,
and `eval "$(fwk completion bash)"` (or zsh, fish) completes commands, options, components, channels, settings and runs.
Exit code 0 means success, 2 bad input, with a sentence that says what would be right.
With several runs on a machine, `--run NAME` or the environment variable `FWK_RUN` chooses one; `fwk-launch --run NAME`
gives a run its name, the default is that of its plan.
"""


def reference() -> str:
    """Returns the page, in Markdown."""
    sections = [
        _HEAD,
        *_sections("fwk-launch", _made(launch_command.app)),
        *_sections("fwk", _made(commands_of_fwk.app)),
    ]
    return "\n".join(sections)


def _made(app: typer.Typer) -> Any:
    return typer.main.get_command(app)


def _sections(path: str, command: Any) -> Iterator[str]:
    """Yields a section for the command, or for each of its subcommands."""
    below = getattr(command, "commands", None)
    if below is None:
        yield _section(path, command)
        return
    for name in below:
        yield from _sections(f"{path} {name}", below[name])


def _section(path: str, command: Any) -> str:
    options = [each for each in command.params if each.param_type_name == "option" and not each.hidden]
    arguments = [each for each in command.params if each.param_type_name == "argument" and not each.hidden]
    words = " ".join([path, *(_argument(each) for each in arguments), *(["[OPTIONS]"] if options else [])])
    rows = [f"| `{_cell(_argument(each))}` | {_cell(each.help)} |" for each in arguments]
    rows += [f"| `{_cell(_option(each))}` | {_cell(each.help)} |" for each in options]
    table = ["| what to type | meaning |", "| --- | --- |", *rows, ""] if rows else []
    examples = EXAMPLES.get(path, ())
    shown = ["```sh", *examples, "```", ""] if examples else []
    return "\n".join([f"## `{words}`", "", cleandoc(command.help or ""), "", *table, *shown])


def _argument(argument: Any) -> str:
    word = str(argument.metavar or argument.name.upper())
    return word if argument.required else f"[{word}]"


def _option(option: Any) -> str:
    names = ", ".join([*option.opts, *option.secondary_opts])
    if option.is_flag:
        return names
    choices = [str(each) for each in type(option.default)] if isinstance(option.default, Enum) else []
    return f"{names} {'|'.join(choices) or option.metavar or option.name.upper()}"


def _cell(text: str | None) -> str:
    return (text or "").replace("|", "\\|").replace("\n", " ")


def index() -> str:
    """Returns the index of commands as JSON, a command a line."""
    commands = [*_all(("fwk-launch",), _made(launch_command.app)), *_all(("fwk",), _made(commands_of_fwk.app))]
    return "[\n" + ",\n".join(json.dumps(_entry(words, each)) for words, each in commands) + "\n]\n"


def _all(words: tuple[str, ...], command: Any) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yields a command, and below a group of commands, each of these."""
    yield words, command
    below = getattr(command, "commands", {})
    for name in below:
        yield from _all((*words, name), below[name])


def _entry(words: tuple[str, ...], command: Any) -> dict[str, Any]:
    hints = get_type_hints(command.callback)
    parameters = [each for each in command.params if each.name in hints]  # not --help
    return {
        "words": words,
        "summary": " ".join(cleandoc(command.help or "").split("\n\n")[0].split()),
        "parameters": [_parameter(each, hints[each.name]) for each in parameters],
    }


def _parameter(each: Any, hint: Any) -> dict[str, Any]:
    kinds = [kind for kind in get_args(hint) or (hint,) if kind is not type(None)]
    is_enum = isinstance(kinds[0], type) and issubclass(kinds[0], Enum)
    literals = [kind for kind in kinds if isinstance(kind, str)]
    is_option = each.param_type_name == "option"
    return {
        "name": each.name,
        "options": [*each.opts, *each.secondary_opts] if is_option else [],
        "metavar": each.metavar or "",
        "flag": is_option and each.is_flag,
        "many": each.nargs == -1 or bool(getattr(each, "multiple", False)),
        "required": each.required,
        "kind": "boolean" if kinds == [bool] else "text" if kinds in ([str], [list[str]]) else "other",
        "choices": [str(choice) for choice in kinds[0]] if is_enum else literals,
    }


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(reference())
    Path(INDEX).write_text(index())

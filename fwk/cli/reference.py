"""Writes docs/commands.md from the commands themselves: python -m fwk.cli.reference."""

from collections.abc import Iterator
from enum import Enum
from inspect import cleandoc
from typing import Any

import typer

from fwk.cli import launch, main

_HEAD = """\
# Commands

Written by `make docs` from the commands themselves; what they say with `--help` stands here too.
Everywhere: exit code 0 means well, 2 bad input with a sentence that says what would be right.
"""


def reference() -> str:
    """The page, in Markdown."""
    sections = [_HEAD, *_sections("fwk-launch", _made(launch.app)), *_sections("fwk", _made(main.app))]
    return "\n".join(sections)


def _made(app: typer.Typer) -> Any:
    return typer.main.get_command(app)


def _sections(path: str, command: Any) -> Iterator[str]:
    """A section for the command, or for each of its subcommands."""
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
    return "\n".join([f"## `{words}`", "", cleandoc(command.help or ""), "", *table])


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


if __name__ == "__main__":
    print(reference(), end="")

"""Reads and checks values of the command line: paces, durations, files, folders, lists of names."""

import os
import re
from contextvars import ContextVar
from enum import StrEnum
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN

_MANY = ("--only", "--without")
_PART_MAX = 100_000.0
"""Largest limit of the parts of a recording, in any unit."""
_LINE_END = re.compile(r"(?<!\n)\n(?=\S)")
"""End of a line within a paragraph."""
_is_incomplete = ContextVar("is_incomplete", default=False)
"""Whether the input of the command lacks a part."""
_LAUNCH_FILES = (".yaml", ".yml")


class Hosting(StrEnum):
    """Distribution of components to processes."""

    PROCESS = "process"
    ROBOT = "robot"
    SINGLE = "single"


class SeveralNames(TyperCommand):
    """Command whose `--only` and `--without` take several names in a row: `--only cyan1 world`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, spread(args))
        except typer.BadParameter as error:
            error.message = error.message.replace("Value error, ", "")  # pydantic's words, in some versions of typer
            raise

    def invoke(self, ctx: Any) -> Any:
        _is_incomplete.set(False)
        result = super().invoke(ctx)
        if _is_incomplete.get():
            raise typer.Exit(1)
        return result

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Writes the help with its paragraphs as wide as the terminal; brackets, as in `fwk[plot]`, are not markup."""
        text = self.help
        self.help = _LINE_END.sub(" ", text or "").replace("[", "\\[")
        try:
            super().format_help(ctx, formatter)
        finally:
            self.help = text


def note_incomplete() -> None:
    """Makes the command that runs end with exit code 1: its input lacks a part, which it has named."""
    _is_incomplete.set(True)


def spread(arguments: list[str]) -> list[str]:
    """Repeats `--only` and `--without` before each of their names, which end at an option or a launch file."""
    made: list[str] = []
    option = ""
    for number, argument in enumerate(arguments):
        option_before = number > 0 and arguments[number - 1] in _MANY
        if argument.startswith("-") or argument.endswith(_LAUNCH_FILES):
            option = argument if argument in _MANY else ""
        elif option and not option_before:
            made.append(option)
        made.append(argument)
    return made


def speed(text: str) -> float:
    """Returns a factor; 0 for `max`.

    Raises:
        BadParameter: the text is neither.
    """
    meaning = f"a pace; use a number from {SPEED_MIN:g} to {SPEED_MAX:g}, such as 0.5 or 2, or 'max'"
    return 0.0 if text == "max" else _number(text, SPEED_MIN, SPEED_MAX, meaning)


def seconds(text: str) -> float:
    """Returns a duration in seconds.

    Raises:
        BadParameter: the text is not a duration.
    """
    meaning = f"a duration; use seconds from 0.001 to {SECONDS_MAX:g}, such as 60 or 0.5"
    return _number(text, 0.001, SECONDS_MAX, meaning)


def record_parts(text: str) -> dict[str, float]:
    """Returns the limit of the parts of a recording: `split_mb` for `200MB`, `split_s` for `60s`.

    Raises:
        BadParameter: the text is neither.
    """
    meaning = (
        f"a limit of parts; use a size such as 200MB or 1.5GB, or a time such as 60s; both from 0.001 to {_PART_MAX:g}"
    )
    for unit, key, factor in (("MB", "split_mb", 1.0), ("GB", "split_mb", 1000.0), ("s", "split_s", 1.0)):
        if text.endswith(unit):
            return {key: factor * _number(text.removesuffix(unit), 0.001, _PART_MAX, meaning, text)}
    raise typer.BadParameter(f"'{text}' is not {meaning}")


def new_file(text: str) -> Path:
    """Returns the absolute path of a file that can be written, in a folder that exists or can be created.

    Raises:
        BadParameter: the text names a folder, or a place without write permission.
    """
    path = Path(text).absolute()
    if os.path.isdir(path):
        raise typer.BadParameter(f"'{text}' is a folder; name a file in it")
    nearest = next(folder for folder in path.parents if os.path.exists(folder))
    if not os.path.isdir(nearest) or not os.access(path if os.path.exists(path) else nearest, os.W_OK):
        raise typer.BadParameter(f"'{text}' cannot be written: {nearest} is not a folder that you may write to")
    return path


def video_file(text: str) -> Path:
    """Returns the absolute path of a new .mp4 file.

    Raises:
        BadParameter: another suffix, or the file cannot be written.
    """
    if Path(text).suffix != ".mp4":
        right = Path(text).with_suffix(".mp4") if Path(text).name else "match.mp4"
        raise typer.BadParameter(f"'{text}' is not an .mp4 file, the only format; use {right}")
    return new_file(text)


def folder(text: str) -> Path:
    """Returns the path of an existing folder.

    Raises:
        BadParameter: no such folder.
    """
    if not os.path.isdir(text or "."):  # also False for text that cannot be a path, and without permission
        raise typer.BadParameter(f"no folder '{text}'")
    return Path(text)


def _number(text: str, least: float, greatest: float, meaning: str, whole: str = "") -> float:
    """Returns a number within limits; `whole` is the text as it was given, if `text` is a part of it."""
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not least <= number <= greatest:
        raise typer.BadParameter(f"'{whole or text}' is not {meaning}")
    return number

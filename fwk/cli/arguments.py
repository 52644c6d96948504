"""Reads values of the command line that are more than a number or a name."""

import os
from enum import StrEnum
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN

_MANY = ("--only", "--without")
_LAUNCH_FILES = (".yaml", ".yml")


class Hosting(StrEnum):
    """Which components share a process."""

    PROCESS = "process"
    ROBOT = "robot"
    SINGLE = "single"


class SeveralNames(TyperCommand):
    """A command whose `--only` and `--without` take several names in a row: `--only cyan1 world`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        return super().parse_args(ctx, spread(args))


def spread(arguments: list[str]) -> list[str]:
    """Repeats `--only` and `--without` before each of their names; names are what is no option and no launch file."""
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
    """A factor, or `max`, which is 0 in plans.

    Raises:
        BadParameter: neither.
    """
    meaning = f"a pace; say a number from {SPEED_MIN:g} to {SPEED_MAX:g}, such as 0.5 or 2, or 'max'"
    return 0.0 if text == "max" else _number(text, SPEED_MIN, SPEED_MAX, meaning)


def seconds(text: str) -> float:
    """A duration.

    Raises:
        BadParameter: it is none.
    """
    meaning = f"a duration; say seconds from 0.001 to {SECONDS_MAX:g}, such as 60 or 0.5"
    return _number(text, 0.001, SECONDS_MAX, meaning)


def new_file(text: str) -> Path:
    """The absolute path of a file that can be written, in a folder that is there or can be made.

    Raises:
        BadParameter: it names a folder, or lies where nothing may be written.
    """
    path = Path(text).absolute()
    if os.path.isdir(path):
        raise typer.BadParameter(f"'{text}' is a folder; name a file in it")
    nearest = next(folder for folder in path.parents if os.path.exists(folder))
    if not os.path.isdir(nearest) or not os.access(path if os.path.exists(path) else nearest, os.W_OK):
        raise typer.BadParameter(f"'{text}' cannot be written: {nearest} is no folder that you may write to")
    return path


def video_file(text: str) -> Path:
    """A new file that ends in .mp4.

    Raises:
        BadParameter: it ends otherwise, or cannot be written.
    """
    if Path(text).suffix != ".mp4":
        right = Path(text).with_suffix(".mp4") if Path(text).name else "match.mp4"
        raise typer.BadParameter(f"'{text}' is no .mp4, the only kind that is written; say {right}")
    return new_file(text)


def folder(text: str) -> Path:
    """A folder that is there.

    Raises:
        BadParameter: it is none.
    """
    if not os.path.isdir(text or "."):  # False, too, for what can be no path or is forbidden
        raise typer.BadParameter(f"there is no folder '{text}'")
    return Path(text)


def _number(text: str, least: float, greatest: float, meaning: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not least <= number <= greatest:
        raise typer.BadParameter(f"'{text}' is not {meaning}")
    return number

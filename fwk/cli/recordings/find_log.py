"""Finds the log of a recording, names missing parts, and turns unreadable files into a sentence and an exit code."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from fwk.cli.arguments import note_incomplete
from fwk.cli.recordings.user_folders import use_types_of_run
from fwk.cli.run.run_directory import named
from fwk.lcm.log_file import LogError
from fwk.lcm.log_parts import exists, is_later_part, is_log
from fwk.lcm.typegen import TypeGenerationError
from fwk.recording.missing_parts import MissingParts, missing_parts


@contextmanager
def failing(code: int) -> Iterator[None]:
    """Turns unreadable files into a sentence on stderr and an exit code."""
    try:
        yield
    except (LogError, TypeGenerationError) as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(code) from error


def find_log(path: Path) -> Path:
    """Returns the log as `located`; if the log lacks parts, the command ends with exit code 1.

    Raises:
        LogError: the directory contains no log, or several, or the file cannot be read.
    """
    log, missing = located(path)
    if missing:
        note_incomplete()
    return log


def find_log_with_types(path: Path, types: Path) -> Path:
    """Returns the log as `find_log` does, and makes the types of its messages available.

    Raises:
        LogError, TypeGenerationError: as `find_log` and `use_types_of_run`.
    """
    log = find_log(path)
    use_types_of_run(log, types)
    return log


def located(path: Path) -> tuple[Path, list[MissingParts]]:
    """Returns the log, and the parts that it lacks, which it names on stderr: the log is read without them.

    The log is the file itself, or the only log in a run directory, which may be given by the name of its run.

    Raises:
        LogError: the directory contains no log, or several, or the file cannot be read.
    """
    path = named(path)
    if str(path) == path.name and not (os.path.lexists(path) or exists(path)):
        raise LogError(f"{path}: cannot read: No such file or directory, and no run of this name; see 'fwk runs list'")
    log = _log_in(path) if os.path.isdir(path) else path  # not a directory: also text that cannot be a path
    missing = missing_parts(log)
    for each in missing:
        typer.echo(f"warning: {each}", err=True)
    return log, missing


def _log_in(path: Path) -> Path:
    found = [file for file in sorted(path.iterdir()) if _begins_log(file)]
    if len(found) != 1:
        names = ", ".join(file.name for file in found) or "none"
        raise LogError(f"{path}: a run directory holds one LCM log, this one: {names}; name the file itself")
    return found[0]


def _begins_log(file: Path) -> bool:
    """Returns whether a file is a log, and not a later part of one."""
    return file.is_file() and is_log(file) and not is_later_part(file)

"""Options, questions and output shared by the commands that change the files of a project."""

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated

import typer

from fwk.cli.output import say
from fwk.plan.files.launch_file import shown
from fwk.program import BAD_INPUT, complain
from fwk.scaffold.changes import Change, ScaffoldError, pending, refuse_overwriting, write

DryRun = Annotated[bool, typer.Option("--dry-run", help="print what would be written, write nothing")]
Force = Annotated[bool, typer.Option("--force", help="overwrite files that exist")]


@contextmanager
def explaining() -> Iterator[None]:
    """Turns a mistake of the user into a sentence on stderr and exit code 2."""
    try:
        yield
    except ScaffoldError as error:
        for line in str(error).splitlines():
            complain(line)
        raise typer.Exit(BAD_INPUT) from error


def asked(value: str | None, question: str, argument: str, default: str | None = None) -> str:
    """Returns a value, asking for it on a terminal if it is missing.

    Raises:
        ScaffoldError: it is missing, has no default, and there is no terminal.
    """
    if value is not None:
        return value
    if sys.stdin.isatty() and sys.stdout.isatty():
        return str(typer.prompt(question, default=default))
    if default is None:
        raise ScaffoldError(f"{argument} is missing; on a terminal the command asks for it")
    return default


def carry_out(changes: Sequence[Change], dry_run: bool, force: bool, as_json: bool, then: Sequence[str] = ()) -> None:
    """Writes the changes, or only shows them, and prints what happened and what to type next.

    Raises:
        ScaffoldError: a file exists and `force` is not given; nothing is written.
    """
    if not force:
        refuse_overwriting(changes)
    wanted = pending(changes)
    if not dry_run:
        write(wanted)
    if as_json:
        rows = [{"path": str(each.path), "change": _word(each)} for each in wanted]
        say(json.dumps({"dry_run": dry_run, "files": rows}, indent=2))
        return
    for each in wanted:
        say(f"{'would be ' if dry_run else ''}{_word(each)}: {shown(each.path)}")
    if not wanted:
        say("nothing to do: all files are as they should be")
    elif not dry_run and then:
        say(f"next: {' && '.join(then)}")


def _word(change: Change) -> str:
    return "made" if change.before is None else "changed"

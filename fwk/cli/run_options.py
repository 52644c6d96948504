"""Options and error handling shared by the commands that ask a run."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer

from fwk.cli.arguments import seconds
from fwk.control import client, runs
from fwk.control.client import ControlError, RefusedError
from fwk.control.runs import RUN_VARIABLE
from fwk.program import BAD_INPUT, FAILED, notice

RunChoice = Annotated[
    str | None,
    typer.Option(
        "--run",
        "--bus-port",
        metavar="NAME|N",
        help=f"the run, by name or bus port; default: {RUN_VARIABLE}, or the only one",
    ),
]
Timeout = Annotated[
    float,
    typer.Option("--timeout", parser=seconds, metavar="SECONDS", help="how long to wait until the request took effect"),
]
Json = Annotated[bool, typer.Option("--json", help="output for programs")]
Names = Annotated[list[str], typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*'")]
SomeNames = Annotated[
    list[str] | None,
    typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*'; all by default"),
]


@contextmanager
def asking() -> Iterator[None]:
    """Turns errors of a run into a sentence on stderr and an exit code; Ctrl-C ends a command that watches.

    A request that has no answer after a second is a note on stderr.
    """
    before = client.notice.set(notice)
    try:
        yield
    except ControlError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(exit_code(error)) from error
    except KeyboardInterrupt as interrupt:
        raise typer.Exit(0) from interrupt
    finally:
        client.notice.reset(before)


def exit_code(error: ControlError) -> int:
    """Returns 2 for bad input, 1 for a run that does not answer or does not exist."""
    return BAD_INPUT if isinstance(error, RefusedError) else FAILED


def ask(chosen: str | int | None, verb: str, timeout_s: float | None = None, **fields: Any) -> dict[str, Any]:
    """Sends one request to the supervisor of a run.

    Raises:
        ControlError: refused, or no answer.
    """
    with runs.supervisor(chosen) as run:
        return run.ask(verb, timeout_s, **fields)

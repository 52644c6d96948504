"""What the commands that ask a run share: which run, and ending with a plain sentence."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer

from fwk.cli.arguments import seconds
from fwk.control import client
from fwk.control.client import ControlError, RefusedError

FAILED = 1
BAD_INPUT = 2

BusPort = Annotated[
    int | None, typer.Option("--bus-port", metavar="N", help="which run, if there are several; as for fwk-launch")
]
Timeout = Annotated[
    float,
    typer.Option("--timeout", parser=seconds, metavar="SECONDS", help="how long to wait until it has happened"),
]
Json = Annotated[bool, typer.Option("--json", help="for programs")]
Names = Annotated[list[str], typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*'")]
SomeNames = Annotated[
    list[str] | None,
    typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*'; all by default"),
]


@contextmanager
def asking() -> Iterator[None]:
    """Turns what goes wrong into its sentence on stderr and an exit code; Ctrl-C ends a command that watches."""
    try:
        yield
    except RefusedError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    except ControlError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(FAILED) from error
    except KeyboardInterrupt as interrupt:
        raise typer.Exit(0) from interrupt


def ask(bus_port: int | None, verb: str, timeout_s: float | None = None, **fields: Any) -> dict[str, Any]:
    """One request to the supervisor of the run that is meant.

    Raises:
        ControlError: refused, or no answer.
    """
    with client.supervisor(bus_port) as run:
        return run.ask(verb, timeout_s, **fields)

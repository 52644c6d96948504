"""`fwk ps`: the runs that are going on."""

import typer

from fwk.cli.look.show_runs import show_runs
from fwk.cli.run_options import Json


def ps(as_json: Json = False) -> None:
    """Lists the runs that are going on: name, port, process, tick and speed; recordings are in `fwk runs list`."""
    raise typer.Exit(show_runs(as_json))

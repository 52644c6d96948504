"""`fwk status`: the state of a run and of its components."""

import typer

from fwk.cli.look.show_status import show_status
from fwk.cli.run_options import Json, RunChoice, SomeNames, asking


def status(names: SomeNames = None, chosen: RunChoice = None, as_json: Json = False) -> None:
    """Shows the run, and the state, process, iterations, times, losses and failure reason of each component.

    For a single component it shows everything that is known of it, including its settings.
    """
    with asking():
        code = show_status(names or [], chosen, as_json)
    raise typer.Exit(code)

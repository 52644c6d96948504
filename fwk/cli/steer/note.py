"""`fwk note TEXT`: a line for the run's log."""

import json
from typing import Annotated

import typer

from fwk.cli.run_options import Json, RunChoice, ask, asking


def note(
    text: Annotated[list[str], typer.Argument(metavar="TEXT", help="a remark about this moment")],
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Writes a line into the log and the recording of a run, to find this moment again; prints the tick."""
    with asking():
        answer = ask(chosen, "note", text=" ".join(text))
    typer.echo(json.dumps(answer) if as_json else f"noted, tick {answer['tick']}")

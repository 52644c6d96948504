"""`fwk step [TICKS]`."""

from typing import Annotated

import typer

from fwk.cli.asking import BusPort, Json, Timeout
from fwk.cli.clock import ask_clock


def step(
    ticks: Annotated[int, typer.Argument(min=1, metavar="TICKS", help="how many; 1 by default")] = 1,
    bus_port: BusPort = None,
    timeout_s: Timeout = 600.0,
    as_json: Json = False,
) -> None:
    """Runs so many more ticks, at the run's speed, then pauses; a run that is not paused yet is paused then."""
    ask_clock("step", bus_port, timeout_s, as_json, ticks=ticks)

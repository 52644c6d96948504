"""`fwk speed [F|max]`."""

from typing import Annotated

import typer

from fwk.cli.arguments import speed as parse_speed
from fwk.cli.asking import BusPort, Json, Timeout
from fwk.cli.clock import ask_clock


def speed(
    pace: Annotated[
        float | None,
        typer.Argument(parser=parse_speed, metavar="F|max", help="logical seconds per second; max: as fast as it goes"),
    ] = None,
    bus_port: BusPort = None,
    timeout_s: Timeout = 30.0,
    as_json: Json = False,
) -> None:
    """Sets how fast simulated time goes, from the next tick on; without a number it says where the clock is."""
    ask_clock("speed", bus_port, timeout_s, as_json, **({} if pace is None else {"speed": pace}))

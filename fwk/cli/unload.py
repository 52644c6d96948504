"""`fwk unload NAME...`."""

from typing import Annotated

import typer

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def unload(
    names: Names,
    force: Annotated[bool, typer.Option("--force", help="unload those too who need them")] = False,
    bus_port: BusPort = None,
    timeout_s: Timeout = WAIT_S,
    as_json: Json = False,
) -> None:
    """Stops components that nobody needs any more.

    Refused as long as another running component needs one of them; all of them have to be named together, or --force
    takes them along. Who only reads what they wrote is no hindrance: it keeps the last value, and is named.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("unload", names, bus_port, timeout_s, as_json, force)

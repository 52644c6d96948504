"""`fwk foxglove`: shows a run in Foxglove while it goes on."""

import json
from typing import Annotated

import typer

from fwk.cli.look.public_messages import listening
from fwk.cli.output import say
from fwk.cli.run_options import Json, RunChoice
from fwk.log_tools.export import INSTALL
from fwk.program import FAILED

PORT = 8765


def foxglove(
    port: Annotated[int, typer.Option(min=0, max=65535, metavar="N", help="port for Foxglove; 0: a free one")] = PORT,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Serves the messages of a run to Foxglove until the run ends: each as its type, and poses, images and more.

    Open Foxglove, choose 'Open connection' and type the address that is printed. Other machines cannot connect.
    `--json` prints one object: name of the run, address and port.
    """
    try:
        from fwk.log_tools.foxglove_server import FoxgloveServer
        from fwk.log_tools.live_frames import LiveFrames
    except ImportError as error:
        typer.echo(f"error: Foxglove needs another library: {INSTALL}", err=True)
        raise typer.Exit(FAILED) from error
    with listening(chosen, "export its recording with fwk export") as (about, messages):
        try:
            server = FoxgloveServer(about["name"], port, LiveFrames(about["pid"]))
        except (OSError, RuntimeError) as error:
            typer.echo(f"error: port {port} cannot be opened: {error}; choose another with --port", err=True)
            raise typer.Exit(FAILED) from error
        address = f"ws://127.0.0.1:{server.port}"
        served = {"name": about["name"], "address": address, "port": server.port}
        say(json.dumps(served) if as_json else f"{about['name']}: {address} for Foxglove; Ctrl-C ends")
        try:
            for message in messages:
                server.show(*message)
        finally:
            server.close()

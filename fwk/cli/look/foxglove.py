"""`fwk foxglove`: shows a run in Foxglove while it goes on."""

from typing import Annotated

import typer

from fwk.cli.look.public_messages import listening
from fwk.cli.output import FAILED
from fwk.cli.run_options import RunChoice
from fwk.log_tools.export import INSTALL

PORT = 8765


def foxglove(
    port: Annotated[int, typer.Option(min=0, max=65535, metavar="N", help="port for Foxglove; 0: a free one")] = PORT,
    chosen: RunChoice = None,
) -> None:
    """Serves the messages of a run to Foxglove until the run ends: each as its type, and poses, images and more.

    Open Foxglove, choose 'Open connection' and type the address that is printed. Other machines cannot connect.
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
        typer.echo(f"{about['name']}: ws://127.0.0.1:{server.port} for Foxglove; Ctrl-C ends")
        try:
            for message in messages:
                server.show(*message)
        finally:
            server.close()

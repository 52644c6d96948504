"""`fwk web`: the console in a browser."""

import re
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.cli.run.console import MISSING, PORT, can_serve
from fwk.cli.run.run_directory import RUNS, run_dirs
from fwk.cli.run.run_record import read_record
from fwk.program import BAD_INPUT, FAILED

_HOST_NAME = re.compile(r"[A-Za-z0-9]([A-Za-z0-9.-]*[A-Za-z0-9])?")
_EVERY = ("0.0.0.0", "::")


def web(
    run: Annotated[
        str,
        typer.Option("--run", metavar="NAME", help="run that pages show at first; each page can choose another"),
    ] = "",
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="TCP port of the console; 0: any free one")
    ] = PORT,
    address: Annotated[
        str, typer.Option(metavar="ADDRESS", help="address to serve on; one beyond this machine needs --certificate")
    ] = "127.0.0.1",
    certificate: Annotated[
        Path | None, typer.Option(exists=True, dir_okay=False, metavar="FILE", help="TLS certificate, PEM")
    ] = None,
    key: Annotated[
        Path | None, typer.Option(exists=True, dir_okay=False, metavar="FILE", help="private key of the certificate")
    ] = None,
    names: Annotated[
        list[str] | None,
        typer.Option("--name", metavar="HOST", help="name of this machine in links, beside its address; repeatable"),
    ] = None,
    views: Annotated[
        list[str] | None,
        typer.Option("--view", metavar="MODULE", help="Python module with views and pages; repeatable"),
    ] = None,
    read_only: Annotated[bool, typer.Option("--read-only", help="show everything, steer nothing")] = False,
    normal_priority: Annotated[
        bool,
        typer.Option("--normal-priority", help="compete with runs for the processors, instead of giving way to them"),
    ] = False,
) -> None:
    """Serves a console in which a browser sees and steers the runs of this machine; Ctrl-C ends it.

    On 127.0.0.1 the kernel tells which user a browser belongs to; only you and root are admitted. On any other address
    the console needs TLS and admits links with a token: one that may steer, one that may only look.
    """
    if not can_serve():
        typer.echo(f"error: {MISSING}", err=True)
        raise typer.Exit(FAILED)
    for name in names or ():
        if not _HOST_NAME.fullmatch(name):
            raise typer.BadParameter(f"--name {name!r}: not the name of a machine, such as robot or robot.local")
    from fwk.web.access import Access, is_loopback, new_tokens

    local = is_loopback(address)
    if not local and not (certificate and key):
        raise typer.BadParameter(
            f"--address {address}: other machines reach it, so it needs TLS; add --certificate FILE --key FILE"
        )
    if address in _EVERY and not names:
        raise typer.BadParameter(
            f"--address {address}: these are all addresses of this machine, and links need one; add --name with the "
            "name or address by which browsers reach it"
        )
    if local and (certificate or key):
        raise typer.BadParameter("--certificate and --key are for addresses beyond this machine; leave them out")
    from fwk.web.background import continue_in_background
    from fwk.web.listener import ServeError, listen

    try:
        listener = listen("127.0.0.1" if address == "localhost" else address, port)
    except ServeError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    with listener:
        tokens = {} if local else new_tokens(read_only)
        access = Access(address, listener.getsockname()[1], read_only, tuple(names or ()), tokens)
        for role, link in access.links().items():
            typer.echo(f"console ({role}): {link}")
        continue_in_background()
        from fwk.web.extensions import ExtensionError
        from fwk.web.server import Options, serve

        try:
            options = Options(access, run, tuple(views or ()), certificate, key, normal_priority)
            serve(options, listener, recordings)
        except ExtensionError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(BAD_INPUT) from error


def recordings() -> list[dict[str, Any]]:
    """Returns the run directories of this user, the newest first."""
    found = []
    for each in reversed(run_dirs(Path.home() / RUNS)):
        record = read_record(each.path)
        about = {
            name: getattr(record, name) for name in ("name", "started_us", "seed", "duration_s", "ticks", "result")
        }
        found.append({"path": str(each.path), "size_bytes": each.size_bytes, "in_use": each.in_use, **about})
    return found

"""`fwk spy`: lcm-spy with all message types."""

from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import folder
from fwk.cli.run_options import RunChoice, ask, asking
from fwk.control import runs
from fwk.lcm.spy_jar import SpyError, build_jar, cache_folder, class_path, start
from fwk.lcm.type_registry import source_folders, use_types_of
from fwk.lcm.typegen import TypeGenerationError
from fwk.model.plan import Plan


def bus_of(chosen: str | None) -> str:
    """Returns the URL of a run's public bus; LCM's default while nothing runs."""
    with asking():
        if chosen is None and not runs.meant():
            return Plan.public_url
        return runs.public_bus(ask(chosen, "run"))


def spy(
    jar: Annotated[bool, typer.Option("--jar", help="only build the jar and print the class path")] = False,
    url: Annotated[str, typer.Option(metavar="URL", help="bus to listen on; default: that of the run")] = "",
    types: Annotated[
        Path, typer.Option(parser=folder, metavar="FOLDER", help="folder whose lcmtypes/ is added")
    ] = Path(),
    chosen: RunChoice = None,
) -> None:
    """Starts lcm-spy with all message types on its class path, so that it shows decoded messages.

    Without a run it listens on LCM's default bus.
    For other Java programs: java -cp "$(fwk spy --jar)" MyProgram
    """
    try:
        use_types_of(types)
        built = build_jar(source_folders(), cache_folder())
        if jar:
            typer.echo(class_path(built))
        else:
            start(built, url or bus_of(chosen))
    except (SpyError, TypeGenerationError) as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(1) from error

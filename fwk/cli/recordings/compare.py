"""`fwk compare A B`: compares the messages of two logs."""

import json
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import folder
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.run_options import Json
from fwk.lcm.type_registry import use_types_of
from fwk.plan.what_ran import other_kernel
from fwk.recording.compare import Comparison, kernel_of

EQUAL, DIFFERENT, UNUSABLE = 0, 1, 2


def compare(
    a: Annotated[Path, typer.Argument(metavar="A", help="log or run directory")],
    b: Annotated[Path, typer.Argument(metavar="B", help="log or run directory")],
    common: Annotated[
        bool, typer.Option("--common", help="only sequence numbers that both logs reach; for logs of different length")
    ] = False,
    types: Annotated[
        Path, typer.Option(parser=folder, metavar="FOLDER", help="folder whose lcmtypes/ defines the messages")
    ] = Path(),
    as_json: Json = False,
) -> None:
    """Compares two logs on every channel outside fwk/ and names the first difference.

    Exit codes: 0 the same messages; 1 different; 2 a file cannot be used.
    """
    with failing(UNUSABLE):
        use_types_of(types)
        logs = find_log(a), find_log(b)
        if text := other_kernel((str(a), str(b)), (kernel_of(logs[0]), kernel_of(logs[1]))):
            typer.echo(text, err=True)
        result = Comparison(*logs, common)
    if as_json:
        difference = str(result.difference) if result.difference else None
        counts = {"messages": result.messages, "channels": result.channels, "damaged_bytes": list(result.skipped_bytes)}
        typer.echo(json.dumps({"equal": difference is None, "difference": difference, **counts}))
        raise typer.Exit(DIFFERENT if difference else EQUAL)
    for path, skipped in zip((a, b), result.skipped_bytes, strict=True):
        if skipped:
            typer.echo(f"{path}: {skipped} damaged bytes passed over", err=True)
    if result.difference:
        typer.echo(f"different: {result.difference}")
        raise typer.Exit(DIFFERENT)
    typer.echo(f"equal: {result.messages} messages on {result.channels} channels")

"""`fwk compare A B`: compares the messages of two logs."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.recordings.find_log import failing, located
from fwk.cli.recordings.log_options import Types
from fwk.cli.recordings.user_folders import use_types_of_run
from fwk.cli.run_options import Json
from fwk.model.plan import Plan
from fwk.plan.what_ran import different_modules, other_kernel
from fwk.recording.compare import Comparison, plan_in
from fwk.recording.differing import differing, lines_of
from fwk.recording.log_index import changed

DIFFERENT, UNUSABLE = 1, 2


def compare(
    a: Annotated[Path, typer.Argument(metavar="A", help="log, or run by its name or directory")],
    b: Annotated[Path, typer.Argument(metavar="B", help="log, or run by its name or directory")],
    common: Annotated[
        bool, typer.Option("--common", help="only sequence numbers that both logs reach; for logs of different length")
    ] = False,
    types: Types = Path(),
    as_json: Json = False,
) -> None:
    """Compares two logs on every channel outside fwk/; names the first difference and all components that differ.

    Exit codes: 0 the same messages; 1 different; 2 a file cannot be used.
    """
    with failing(UNUSABLE):
        logs = located(a)[0], located(b)[0]  # equal logs may both lack a part
        for log in logs:
            use_types_of_run(log, types)
        plans = plan_in(logs[0]), plan_in(logs[1])
        notes = list(_different_conditions((str(a), str(b)), plans))
        result = Comparison(*logs, common)
        if result.difference:
            notes += [
                f"{path}: damaged: {part}" for path, log in zip((a, b), logs, strict=True) for part in changed(log)
            ]
        for text in notes:
            typer.echo(text, err=True)
        rows = differing(result.differences, plans[0] or plans[1])
    if as_json:
        difference = str(result.difference) if result.difference else None
        counts = {"messages": result.messages, "channels": result.channels, "damaged_bytes": list(result.skipped_bytes)}
        components = [row.plain() for row in rows]
        answer = {"equal": difference is None, "difference": difference, "components": components, **counts}
        typer.echo(json.dumps({**answer, "notes": notes}))
        if difference:
            raise typer.Exit(DIFFERENT)
        return
    for path, skipped in zip((a, b), result.skipped_bytes, strict=True):
        if skipped:
            typer.echo(f"{path}: {skipped} damaged bytes skipped", err=True)
    if result.difference:
        typer.echo(f"different: {result.difference}")
        for line in lines_of(rows):
            typer.echo(line)
        raise typer.Exit(DIFFERENT)
    typer.echo(f"equal: {result.messages} messages on {result.channels} channels")


def _different_conditions(names: tuple[str, str], plans: tuple[Plan | None, Plan | None]) -> Iterator[str]:
    """Yields the different conditions of the two runs: the BLAS kernel and the content of modules."""
    if plans[0] is None or plans[1] is None:
        return
    if text := other_kernel(names, (plans[0].blas_kernel, plans[1].blas_kernel)):
        yield text
    for module in different_modules((plans[0], plans[1])):
        yield f"{module} was not the same module in both runs: {' and '.join(_places(module, (plans[0], plans[1])))}"


def _places(module: str, plans: tuple[Plan, Plan]) -> list[str]:
    return [f"{plan.modules[module].file} with hash {plan.modules[module].sha256}" for plan in plans]

"""`fwk runs`: the run directories, which of them stay, and removing old ones."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from fwk.cli.run.run_directory import KEEP, RUNS, RunDir, prune, run_dirs
from fwk.cli.run_options import BAD_INPUT, Json
from fwk.model.errors import hint
from fwk.model.plan import RunsPlan

GB = 1_000_000_000
_MB = 1_000_000

runs = typer.Typer(add_completion=False, no_args_is_help=True)
RunName = Annotated[str, typer.Argument(metavar="RUN", help="name of a run directory")]


def _gigabytes(text: object) -> float:
    try:
        number = float(str(text))
    except ValueError:
        number = -1.0
    if not 0 <= number <= 1e6:
        raise typer.BadParameter(f"'{text}' is no size; say gigabytes, such as 20 or 0.5")
    return number


@runs.callback()
def run_directories() -> None:
    """Lists the run directories in ~/.cache/fwk/runs, and removes old ones.

    `fwk-launch` removes the oldest by itself when there are more than `runs` of the launch file says.
    """


@runs.command("list")
def list_runs(as_json: Json = False) -> None:
    """Lists all run directories, the oldest first."""
    found = run_dirs(Path.home() / RUNS)
    if as_json:
        typer.echo(json.dumps([_plain(each) for each in found], indent=2))
        return
    table = Table("run", "MB", "", box=None, pad_edge=False)
    for each in found:
        table.add_row(each.path.name, f"{each.size_bytes / _MB:.1f}", _word(each))
    table.add_row("together", f"{sum(each.size_bytes for each in found) / _MB:.1f}", str(Path.home() / RUNS))
    Console(width=200).print(table)


@runs.command("prune")
def prune_runs(
    keep: Annotated[int, typer.Option(min=0, metavar="N", help="how many stay; 0: any number")] = RunsPlan.keep,
    size_gb: Annotated[
        float, typer.Option(parser=_gigabytes, metavar="GB", help="how large they may be together; 0: any size")
    ] = RunsPlan.size_gb,
) -> None:
    """Removes the oldest runs that are more than that; never the newest, one in use, or one that is kept."""
    folder = Path.home() / RUNS
    for each in prune(folder, keep, round(size_gb * GB)) if folder.is_dir() else []:
        typer.echo(f"removed {each.path.name}, {each.size_bytes / _MB:.1f} MB")


@runs.command("keep")
def keep_run(run: RunName) -> None:
    """Keeps a run directory from being removed by itself."""
    (_named(run) / KEEP).touch()


@runs.command("release")
def release_run(run: RunName) -> None:
    """Lets a run directory be removed again."""
    (_named(run) / KEEP).unlink(missing_ok=True)


def _named(name: str) -> Path:
    there = {each.path.name: each.path for each in run_dirs(Path.home() / RUNS)}
    if name not in there:
        typer.echo(f"error: no run '{name}' in {Path.home() / RUNS}; {hint(name, there)}", err=True)
        raise typer.Exit(BAD_INPUT)
    return there[name]


def _word(run: RunDir) -> str:
    return "in use" if run.in_use else "kept" if run.kept else ""


def _plain(run: RunDir) -> dict[str, object]:
    return {"path": str(run.path), "size_bytes": run.size_bytes, "in_use": run.in_use, "kept": run.kept}

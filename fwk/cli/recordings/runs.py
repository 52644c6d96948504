"""`fwk runs`: lists the run directories, keeps some, and removes old ones."""

import json
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.output import say_table
from fwk.cli.run.run_directory import GB, KEEP, RUNS, RunDir, called, prune, run_dirs
from fwk.cli.run.run_record import RunRecord, age_s, read_record
from fwk.cli.run_options import Json
from fwk.clock import US_PER_S
from fwk.control.runs import states
from fwk.display.table import Column, Table
from fwk.model.errors import hint
from fwk.model.sections import RunsPlan
from fwk.program import BAD_INPUT

_MB = 1_000_000

runs = typer.Typer(add_completion=False, no_args_is_help=True)
RunName = Annotated[str, typer.Argument(metavar="RUN", help="run directory, by its name, or by that of its run")]


def _gigabytes(text: object) -> float:
    try:
        number = float(str(text))
    except ValueError:
        number = -1.0
    if not 0 <= number <= 1e6:
        raise typer.BadParameter(f"'{text}' is not a size; give gigabytes, such as 20 or 0.5")
    return number


@runs.callback()
def run_directories() -> None:
    """Lists the run directories in ~/.cache/fwk/runs, and removes old ones.

    `fwk-launch` removes the oldest by itself when there are more than `runs` in the launch file allows.
    """


@runs.command("list")
def list_runs(as_json: Json = False) -> None:
    """Lists all run directories, the oldest first: start, duration, seed, result, size, and state."""
    found = run_dirs(Path.home() / RUNS)
    waiting = _waiting() if any(each.in_use for each in found) else {}
    if as_json:
        typer.echo(json.dumps([_plain(each, waiting.get(str(each.path), [])) for each in found], indent=2))
        return
    table = Table(
        "run",
        Column("started", rank=6),
        Column("duration", right=True, rank=3),
        Column("ticks", right=True, rank=5),
        Column("seed", right=True, rank=4),
        Column("MB", right=True, rank=2),
        Column("", rank=1),
        Column("result", prose=True, rank=1),
    )
    for each in found:
        record = read_record(each.path)
        seed, ticks = ("" if number is None else number for number in (record.seed, record.ticks))
        size = f"{each.size_bytes / _MB:.1f}"
        table.add(
            *(each.path.name, _started(record), _duration(each, record), ticks, seed, size, _word(each)),
            _result(each, record, waiting.get(str(each.path), [])),
            style="green" if each.in_use else "red" if record.exit_code else "",
        )
    say_table(table)
    typer.echo(f"{len(found)} runs, {sum(each.size_bytes for each in found) / _MB:.1f} MB, in {Path.home() / RUNS}")


@runs.command("prune")
def prune_runs(
    keep: Annotated[
        int, typer.Option(min=0, metavar="N", help="number of run directories; 0: any number")
    ] = RunsPlan.keep,
    size_gb: Annotated[
        float, typer.Option(parser=_gigabytes, metavar="GB", help="size of all run directories; 0: any size")
    ] = RunsPlan.size_gb,
) -> None:
    """Removes the oldest runs beyond these limits; never the newest, one that goes on, or one that is kept."""
    folder = Path.home() / RUNS
    for each in prune(folder, keep, round(size_gb * GB)) if folder.is_dir() else []:
        typer.echo(f"removed {each.path.name}, {each.size_bytes / _MB:.1f} MB")


@runs.command("keep")
def keep_run(run: RunName) -> None:
    """Keeps a run directory from being removed automatically."""
    (_named(run) / KEEP).touch()


@runs.command("release")
def release_run(run: RunName) -> None:
    """Allows a run directory to be removed again."""
    (_named(run) / KEEP).unlink(missing_ok=True)


def _named(name: str) -> Path:
    there = {each.path.name: each.path for each in run_dirs(Path.home() / RUNS)}
    found = called(name, there.values())
    if not found:
        typer.echo(f"error: no run '{name}' in {Path.home() / RUNS}; {hint(name, there)}", err=True)
        raise typer.Exit(BAD_INPUT)
    return found


def _word(run: RunDir) -> str:
    return "running" if run.in_use else "kept" if run.kept else ""


def _started(record: RunRecord) -> str:
    if record.started_us is None:
        return ""
    return datetime.fromtimestamp(record.started_us / US_PER_S, UTC).astimezone().strftime("%Y-%m-%d %H:%M:%S")


def _duration(run: RunDir, record: RunRecord) -> str:
    seconds = age_s(record) if run.in_use and record.duration_s is None else record.duration_s
    return "" if seconds is None else f"{seconds:.1f} s"


def _waiting() -> dict[str, list[str]]:
    """Returns the components that each run of this machine waits for, by run directory."""
    return {run["run_dir"]: run["waits_for"] for run in states() if {"run_dir", "waits_for"} <= run.keys()}


def _result(run: RunDir, record: RunRecord, waits_for: list[str]) -> str:
    if waits_for:
        return f"waits for {', '.join(waits_for)}"
    result = "; ".join(record.result.splitlines())
    return result if result or run.in_use or record.started_us is None else "ended without a result"


def _plain(run: RunDir, waits_for: list[str]) -> dict[str, object]:
    about = {"path": str(run.path), "size_bytes": run.size_bytes, "in_use": run.in_use, "kept": run.kept}
    return {**about, "waits_for": waits_for, **asdict(read_record(run.path))}

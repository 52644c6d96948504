"""`fwk eval FILE`: plays a launch file with many seeds at the same time, and measures it."""

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import seconds
from fwk.cli.output import BAD_INPUT, FAILED
from fwk.cli.recordings.user_folders import use_folders
from fwk.model.errors import PlanError
from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan
from fwk.testing.campaign import Campaign, Evaluation, FolderError
from fwk.testing.executors import CampaignError, executor_of


def eval(  # noqa: A001 - the name of the command
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file that names an 'evaluation'")],
    seeds: Annotated[str, typer.Option(metavar="FIRST..LAST", help="a run is played with each seed")] = "1..4",
    time_s: Annotated[
        float, typer.Option("--time", parser=seconds, metavar="SECONDS", help="logical time of each run")
    ] = 25.0,
    jobs: Annotated[int, typer.Option(min=0, help="runs at the same time; 0: one a processor")] = 0,
    cluster: Annotated[str, typer.Option(metavar="ADDRESS", help="scheduler of a Dask cluster instead")] = "",
    sets: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="override a setting; repeatable")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FOLDER", help="results; by default eval-NAME")
    ] = None,
) -> None:
    """Plays a launch file with many seeds and measures it; an interrupted evaluation goes on where it was.

    FOLDER gets the result of each seed, and what the launch file's evaluation makes of them: tables, pictures.
    A cluster needs: pip install 'fwk[eval]'; its workers need this project and the launch file at the same place.

    Exit codes: 0 measured; 1 a run failed, or there is no cluster; 2 bad input, or a folder that cannot hold results.
    """
    try:
        plan = load_plan(file, LaunchOptions(sets=sets or ()))
    except PlanError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from error
    if not plan.evaluation:
        typer.echo(f"error: {file} names no 'evaluation: module:function'", err=True)
        raise typer.Exit(BAD_INPUT)
    use_folders(plan.folders)
    numbers, folder = _numbers(seeds), out or Path(f"eval-{plan.name}")
    about = {"file": plan.file, "time_s": time_s, "by": plan.evaluation, "plan": _digest(plan)}
    work = Evaluation(plan.evaluation, plan.folders, tuple(sets or ()))
    try:
        with _refused_by(folder):
            campaign = Campaign(folder, about | ({"sets": sets} if sets else {}))
        failure = _play(campaign, work, file, time_s, numbers, jobs, cluster)
        results, text = campaign.results(numbers), ""
        if results:
            with _refused_by(folder):
                text = import_module(plan.evaluation.partition(":")[0]).report(results, folder)
    except CampaignError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT if isinstance(error, FolderError) else FAILED) from error
    if results:
        typer.echo(text)
    if failure:
        typer.echo(f"error: {failure}", err=True)
        raise typer.Exit(FAILED)


def _play(campaign: Campaign, work: Evaluation, file: str, time_s: float, seeds: range, jobs: int, cluster: str) -> str:
    """Plays the runs that have no whole result yet; returns why runs have none, or an empty text.

    Raises:
        FolderError: a result cannot be read or written.
    """
    for damaged, flaw in campaign.damaged(seeds).items():
        typer.echo(f"note: {damaged} is damaged: {flaw}; its seed is played again", err=True)
    left = campaign.missing(seeds)
    if not left:
        return ""
    label = f"{len(left)} of {len(seeds)} runs"
    try:
        with (
            executor_of(min(jobs or os.cpu_count() or 1, len(left)), cluster) as executor,
            typer.progressbar(length=len(left), label=label, file=sys.stderr) as bar,
        ):
            for _ in campaign.play(work, file, time_s, left, executor):
                bar.update(1)
    except FolderError:
        raise
    except CampaignError as error:
        return str(error)
    return ""


@contextmanager
def _refused_by(folder: Path) -> Iterator[None]:
    """Names what cannot be read or written in the folder of the results.

    Raises:
        FolderError: something cannot be.
    """
    try:
        yield
    except OSError as error:
        raise FolderError(f"--out {error.filename or folder}: {error.strerror or error}") from error


def _digest(plan: Plan) -> str:
    """Returns a digest of the components with their settings, channels and turns: runs of others are not mixed in."""
    played = [
        (each.name, each.module, each.class_name, each.config, each.channels, each.every, each.offset)
        for each in plan.components
    ]
    return hashlib.sha256(repr((plan.period_us, played)).encode()).hexdigest()[:16]


def _numbers(text: str) -> range:
    """Returns the seeds `1..4`, or the one `7`.

    Raises:
        BadParameter: the text is neither.
    """
    first, dots, last = text.partition("..")
    try:
        found = range(int(first), int(last if dots else first) + 1)
    except ValueError:
        found = range(0)
    if not found or found.start < 0:
        raise typer.BadParameter(f"--seeds: '{text}' is not a range of seeds; use 1..20, or 7")
    return found

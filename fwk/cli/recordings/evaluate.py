"""`fwk eval FILE`: plays a launch file with many seeds at the same time, and measures it."""

import os
import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import seconds
from fwk.cli.output import BAD_INPUT
from fwk.cli.recordings.user_folders import use_folders
from fwk.model.errors import PlanError
from fwk.plan.load import load_plan
from fwk.testing.campaign import Campaign, CampaignError, executor_of


def eval(  # noqa: A001 - the name of the command
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file that names an 'evaluation'")],
    seeds: Annotated[str, typer.Option(metavar="FIRST..LAST", help="a run is played with each seed")] = "1..4",
    time_s: Annotated[
        float, typer.Option("--time", parser=seconds, metavar="SECONDS", help="logical time of each run")
    ] = 25.0,
    jobs: Annotated[int, typer.Option(min=0, help="runs at the same time; 0: one a processor")] = 0,
    cluster: Annotated[str, typer.Option(metavar="ADDRESS", help="scheduler of a Dask cluster instead")] = "",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FOLDER", help="results; by default eval-NAME")
    ] = None,
) -> None:
    """Plays a launch file with many seeds and measures it; an interrupted evaluation goes on where it was.

    Exit codes: 0 measured; 1 a run failed, or there is no cluster; 2 bad input.
    """
    try:
        plan = load_plan(file)
    except PlanError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from error
    if not plan.evaluation:
        typer.echo(f"error: {file} names no 'evaluation: module:function'", err=True)
        raise typer.Exit(BAD_INPUT)
    use_folders(plan.folders)
    name, _, function = plan.evaluation.partition(":")
    module, numbers = import_module(name), _numbers(seeds)
    folder = out or Path(f"eval-{plan.name}")
    try:
        campaign = Campaign(folder, {"file": plan.file, "time_s": time_s, "by": plan.evaluation})
        left = campaign.missing(numbers)
        with (
            executor_of(jobs or os.cpu_count() or 1, cluster) as executor,
            typer.progressbar(length=len(left), label=f"{len(left)} of {len(numbers)} runs", file=sys.stderr) as bar,
        ):
            for _ in campaign.play(getattr(module, function), file, time_s, left, executor):
                bar.update(1)
    except CampaignError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(1) from error
    typer.echo(module.report(campaign.results(numbers), folder))


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

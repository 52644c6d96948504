"""`fwk check FILE`: is there anything wrong in a launch file?"""

import sys
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from fwk.cli.arguments import Hosting
from fwk.clock import rate_word
from fwk.display.plan_overview import counted, overview, value_at
from fwk.model.errors import PlanError
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from fwk.plan.load import LaunchOptions, load_plan

BAD_INPUT = 2
WIDTH_IN_A_PIPE = 240


def check(
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file, looked for as given, then in launch/")],
    channels: Annotated[
        bool, typer.Option("--channels", help="list all channels with their writers and readers")
    ] = False,
    settings: Annotated[
        bool, typer.Option("--settings", help="list all settings with their values and origins")
    ] = False,
    sets: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="override a setting; repeatable")
    ] = None,
    hosting: Annotated[
        Hosting, typer.Option(help="one process a component, one a namespace, or one for all")
    ] = Hosting.PROCESS,
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="only these components; repeatable")] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="all but these components; repeatable")
    ] = None,
) -> None:
    """Checks a launch file and everything it uses, and starts nothing.

    Exit codes: 0 it can be run, 2 it cannot; then every mistake is listed with its place.
    """
    options = LaunchOptions(sets=sets or (), hosting=hosting.value, only=only or (), without=without or ())
    try:
        plan = load_plan(file, options)
    except PlanError as error:
        for problem in error.problems:
            place, rest = problem.place, str(problem).removeprefix(problem.place)
            typer.echo(typer.style(place, bold=True) + rest, err=True)
        typer.echo(counted(len(error.problems), "mistake"), err=True)
        raise typer.Exit(BAD_INPUT) from error
    console = Console(width=None if sys.stdout.isatty() else WIDTH_IN_A_PIPE)
    for line in overview(plan):
        console.print(line, highlight=False, markup=False, soft_wrap=True)
    if channels:
        console.print(_channel_table(plan))
    if settings:
        console.print(_settings_table(plan))


def _channel_table(plan: Plan) -> Table:
    table = Table("channel", "type", "writer", "stage", "readers", box=None, pad_edge=False)
    for channel in plan.channels:
        readers = ", ".join(plan.components[index].name for index in channel.readers)
        table.add_row(channel.name, channel.type_name, *_writer(plan, channel), readers)
    return table


def _writer(plan: Plan, channel: ChannelPlan) -> tuple[str, str]:
    if channel.writer == NOBODY:
        return plan.writer_of(channel) or "nobody", ""
    writer = plan.components[channel.writer]
    if writer.rate_hz is not None:
        return writer.name, rate_word(writer.rate_hz)
    return writer.name, ", ".join(plan.stages[index] for index in writer.stages)


def _settings_table(plan: Plan) -> Table:
    table = Table("setting", "value", "origin", box=None, pad_edge=False)
    for component in plan.components:
        for key, origin in component.origins.items():
            table.add_row(f"{component.name}.{key}", str(value_at(component.config, key)), origin)
    return table

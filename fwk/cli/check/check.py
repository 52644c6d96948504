"""`fwk check FILE`: finds all mistakes of a launch file."""

import json
from typing import Annotated, Any

import typer

from fwk.cli.arguments import Hosting
from fwk.cli.output import say, say_table
from fwk.cli.plan_options import ProcessHosting, Sets
from fwk.cli.run_options import Json
from fwk.clock import rate_word, turns_word
from fwk.display.plan_overview import as_typed, counted, overview, value_at
from fwk.display.table import Column, Table
from fwk.model.errors import PlanError, Problem
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from fwk.model.plan_document import document_of
from fwk.plan.load import LaunchOptions, load_plan
from fwk.program import BAD_INPUT, notice


def check(
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file, looked for as given, then in launch/")],
    channels: Annotated[
        bool, typer.Option("--channels", help="list all channels with their writers and readers")
    ] = False,
    settings: Annotated[
        bool, typer.Option("--settings", help="list all settings with their values and origins")
    ] = False,
    sets: Sets = None,
    hosting: ProcessHosting = Hosting.PROCESS,
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="only these components; repeatable")] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="all but these components; repeatable")
    ] = None,
    outside: Annotated[
        list[str] | None,
        typer.Option(metavar="CHANNEL", help="with --without: programs outside write this channel; repeatable"),
    ] = None,
    as_json: Json = False,
) -> None:
    """Checks a launch file and everything it uses, and starts nothing.

    Exit codes: 0 the file can be run, 2 it cannot; then every mistake is listed with its place.
    """
    options = LaunchOptions(
        sets=sets or (), hosting=hosting.value, only=only or (), without=without or (), outside=outside or ()
    )
    try:
        plan = load_plan(file, options, notice)
    except PlanError as error:
        if as_json:
            say(json.dumps({"ok": False, "mistakes": [_plain(each) for each in error.problems]}, indent=2))
            raise typer.Exit(BAD_INPUT) from error
        for problem in error.problems:
            place, rest = problem.place, str(problem).removeprefix(problem.place)
            typer.echo(typer.style(place, bold=True) + rest, err=True)
        typer.echo(counted(len(error.problems), "mistake"), err=True)
        raise typer.Exit(BAD_INPUT) from error
    if as_json:
        say(json.dumps({"ok": True, "mistakes": [], "plan": document_of(plan)}, indent=2))
        return
    say(*overview(plan))
    if channels:
        say_table(_channel_table(plan))
    if settings:
        say_table(_settings_table(plan))


def _plain(problem: Problem) -> dict[str, Any]:
    return {"place": problem.place, "component": problem.who, "text": problem.text}


def _channel_table(plan: Plan) -> Table:
    table = Table(
        "channel", Column("type", rank=2), "writer", Column("stage", rank=3), Column("readers", rank=1, prose=True)
    )
    for channel in plan.channels:
        readers = ", ".join(plan.components[index].name for index in channel.readers)
        table.add(channel.name, channel.type_name, *_writer(plan, channel), readers)
    return table


def _writer(plan: Plan, channel: ChannelPlan) -> tuple[str, str]:
    if channel.writer == NOBODY:
        return plan.writer_of(channel) or "none", ""
    writer = plan.components[channel.writer]
    if writer.rate_hz is not None:
        return writer.name, rate_word(writer.rate_hz)
    stages = ", ".join(plan.stages[index] for index in writer.stages)
    return writer.name, stages + turns_word(writer.every, writer.offset)


def _settings_table(plan: Plan) -> Table:
    table = Table("setting", "value", Column("origin", rank=1))
    for component in plan.components:
        for key, origin in component.origins.items():
            table.add(f"{component.name}.{key}", as_typed(value_at(component.config, key)), origin)
    return table

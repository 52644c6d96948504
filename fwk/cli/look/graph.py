"""`fwk graph` and `fwk who`: how the components of a system are connected."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from fwk.cli.look.channel_rates import channels_with_rates
from fwk.cli.run_options import Json, RunChoice, ask, asking
from fwk.display.graph import Graph, channel_rows, graph_of
from fwk.display.graph import graph as made
from fwk.display.graph_svg import svg
from fwk.display.plan_overview import counted
from fwk.model.errors import PlanError, hint
from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan
from fwk.program import BAD_INPUT, notice


class Form(StrEnum):
    """Form in which the graph is written."""

    TEXT = "text"
    MERMAID = "mermaid"
    SVG = "svg"


_FORMS: dict[Form, Callable[[Graph], str]] = {
    Form.TEXT: lambda graph: "".join(f"{line}\n" for line in graph.lines()),
    Form.MERMAID: lambda graph: "".join(f"{line}\n" for line in graph.mermaid()),
    Form.SVG: svg,
}
File = Annotated[str, typer.Option("--file", metavar="FILE", help="a launch file instead of a run")]


def graph(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*', with their neighbours"),
    ] = None,
    file: File = "",
    form: Annotated[Form, typer.Option("--form", help="how to write it")] = Form.TEXT,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="PATH", help="write into a file; .svg and .mmd give the form")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows components by stage and the channels between them, of a run with states and rates, or of a launch file.

    Exit codes: 0 shown; 1 no run answers; 2 bad input.
    """
    _refuse_launch_files(names or (), file)
    found = _graph(file, chosen)
    if names:
        known = [node.name for node in found.nodes]
        for name in names:
            if not any(fnmatchcase(each, name) for each in known):
                _refuse(f"no component '{name}' in {found.name}; {hint(name, known)}")
        found = found.around(names)
    if out:
        form = {".svg": Form.SVG, ".mmd": Form.MERMAID}.get(out.suffix, form)
    text = json.dumps(asdict(found), indent=2) + "\n" if as_json else _FORMS[form](found)
    if not out:
        typer.echo(text, nl=False)
        return
    try:
        out.write_text(text)
    except OSError as error:
        _refuse(f"{out}: cannot be written: {error.strerror}")
    typer.echo(f"{out}: {counted(len(found.nodes), 'component')}, {counted(len(found.edges), 'connection')}")


def who(
    channels: Annotated[list[str], typer.Argument(metavar="CHANNEL...", help="channels, or patterns such as '*/ball'")],
    file: File = "",
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Names the writer and the readers of channels, of a run or of a launch file.

    Exit codes: 0 shown; 1 no run answers; 2 bad input.
    """
    _refuse_launch_files(channels, file)
    rows = _rows(file, chosen)
    known = [row["channel"] for row in rows]
    for pattern in channels:
        if not any(fnmatchcase(each, pattern) for each in known):
            _refuse(f"no channel '{pattern}'; {hint(pattern, known)}")
    wanted = [row for row in rows if any(fnmatchcase(row["channel"], each) for each in channels)]
    if as_json:
        typer.echo(json.dumps(wanted, indent=2))
        return
    for row in wanted:
        rate = f", {row['rate_hz']:.1f} Hz" if "rate_hz" in row else ""
        typer.echo(f"{row['channel']} ({row['type']}{rate})")
        typer.echo(f"  written by  {row['writer'] or 'no component'}")
        typer.echo(f"  read by     {', '.join(row['readers']) or 'no component'}")


def _refuse_launch_files(names: Sequence[str], file: str) -> None:
    """Names the option that a launch file among the arguments needs."""
    for name in names:
        if name.endswith((".yaml", ".yml")) and not file:
            _refuse(f"'{name}' is a launch file; write: --file {name}")


def _graph(file: str, chosen: str | None) -> Graph:
    if file:
        return graph_of(_plan(file))
    with asking():
        about, now = ask(chosen, "run"), ask(chosen, "status")
    stages = list(dict.fromkeys(stage for each in now["components"] for stage in each["stages"]))
    order = [*now.get("order", []), *stages]
    ordered = [stage for stage in dict.fromkeys(order) if stage in stages]
    return made(about["plan"], ordered, now["components"], _rows("", chosen))


def _rows(file: str, chosen: str | None) -> list[dict[str, Any]]:
    """Returns a row for each channel, of a run with its rate."""
    if not file:
        with asking():
            return channels_with_rates(chosen)
    return channel_rows(_plan(file))


def _plan(file: str) -> Plan:
    try:
        return load_plan(file, LaunchOptions(), notice)
    except PlanError as error:
        for problem in error.problems:
            typer.echo(str(problem), err=True)
        raise typer.Exit(BAD_INPUT) from error


def _refuse(text: str) -> NoReturn:
    typer.echo(f"error: {text}", err=True)
    raise typer.Exit(BAD_INPUT)

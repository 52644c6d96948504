"""`fwk log`: the text log of a run."""

import json
import os
from collections.abc import Callable
from enum import StrEnum
from itertools import islice
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.conditions import moment_us, pattern, ticks, times_us
from fwk.cli.run.run_directory import RUNS, in_use, named
from fwk.cli.run_options import Json, RunChoice, ask, asking
from fwk.control.address import running
from fwk.control.client import ControlError
from fwk.display.lines import log_line
from fwk.logs.json_lines import FILE
from fwk.logs.reader import Filter, from_plain, read_lines
from fwk.logs.rotating import names


class Level(StrEnum):
    """Levels of lines, the least severe first."""

    DEBUG = "debug"
    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


def log(
    run_dir: Annotated[
        Path | None,
        typer.Argument(
            metavar="RUN", help="run directory or its name; default: that of the current run, or the newest"
        ),
    ] = None,
    follow: Annotated[bool, typer.Option("--follow", "-f", help="wait for more until the run ends")] = False,
    last: Annotated[
        int | None, typer.Option("--last", "-n", min=0, metavar="N", help="only the last N of them")
    ] = None,
    level: Annotated[
        Level, typer.Option(metavar="LEVEL", help="lines of this level and above: debug, info, warning, error")
    ] = Level.DEBUG,
    component: Annotated[str | None, typer.Option(metavar="NAME", help="lines of this component or pattern")] = None,
    tick: Annotated[str | None, typer.Option(metavar="N|A..B", help="lines of this tick, or from A to B")] = None,
    time: Annotated[str | None, typer.Option(metavar="A..B", help="lines from A to B seconds of logical time")] = None,
    file: Annotated[str | None, typer.Option(metavar="NAME", help="lines written in this source file")] = None,
    line: Annotated[int | None, typer.Option(metavar="N", help="lines written at this line of the source file")] = None,
    text: Annotated[str | None, typer.Option(metavar="REGEXP", help="lines whose text matches, ignoring case")] = None,
    since: Annotated[
        str | None, typer.Option(metavar="SECONDS|HH:MM:SS", help="from so many seconds ago, or from a time of day")
    ] = None,
    until: Annotated[
        str | None, typer.Option(metavar="SECONDS|HH:MM:SS", help="until so many seconds ago, or until a time of day")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows the log lines of components and framework that meet all conditions.

    With `--last` and `--follow`, the last lines come first, and then every new one.

    In A..B one end may be left out. With `--json` a line is an object with the fields of core.log_t.
    """
    wanted = Filter(
        level=level.value,
        component=component,
        tick=ticks(tick) if tick else None,
        time_us=times_us(time) if time else None,
        file=file,
        line=line,
        text=pattern(text, "--text") if text else None,
        since_us=moment_us(since, "--since") if since else None,
        until_us=moment_us(until, "--until") if until else None,
    )
    with asking():
        path, runs = _find(run_dir, chosen)
        skipped = 0 if last is None else max(0, sum(map(wanted.wants, read_lines(path))) - last)
        lines = filter(wanted.wants, read_lines(path, runs if follow else lambda: False))
        for each in islice(lines, skipped, None):
            typer.echo(json.dumps(each) if as_json else log_line(from_plain(each)))


def _find(run_dir: Path | None, chosen: str | None) -> tuple[Path, Callable[[], bool]]:
    """Returns the log, and a function that tells whether it may still grow."""
    if run_dir is None:
        try:
            run = ask(chosen, "run")
            run_dir = Path(run["run_dir"])
        except ControlError:
            folders = sorted((Path.home() / RUNS).glob("*"))
            if chosen is not None or running() or not folders:
                raise
            run_dir = folders[-1]
    folder = named(run_dir)
    return _there(folder), lambda: in_use(folder)


def _there(run_dir: Path) -> Path:
    if not os.path.isdir(run_dir):
        raise typer.BadParameter(f"{run_dir}: no such folder, and no run of this name; see 'fwk runs list'")
    if not any(os.path.isfile(each) for each in names(run_dir / FILE, 2)):
        right = "name a run directory; one of a plan with 'log: {json_lines: off}' has none"
        raise typer.BadParameter(f"{run_dir}: there is no {FILE} in it; {right}")
    return run_dir / FILE

"""`fwk plot CHANNEL.FIELD...`: draws values of a live run or of a recording over time."""

import json
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.cli.arguments import new_file, seconds
from fwk.cli.look.public_messages import listening
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import Force, Types
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json, RunChoice
from fwk.clock import US_PER_S, monotonic_us
from fwk.display.table import has_colour, terminal_width
from fwk.lcm.event_log import LogError
from fwk.lcm.type_registry import decoded, types_of, use_types_of
from fwk.log_tools.new_file import new_file as complete_file
from fwk.log_tools.series import SeriesOf, series_in
from fwk.program import BAD_INPUT

_FORMATS = ("png", "svg")
_COLUMNS, _ROWS = 100, 24
_REDRAW_US = US_PER_S // 4
_INSTALL = "pip install 'fwk[plot]'"


def _picture(text: str) -> Path:
    """Returns the absolute path of a new picture.

    Raises:
        BadParameter: the suffix is neither .png nor .svg.
    """
    if Path(text).suffix.removeprefix(".") not in _FORMATS:
        raise typer.BadParameter(f"'{text}' is not a picture that can be drawn; use .png or .svg")
    return new_file(text)


def plot(
    paths: Annotated[
        list[str],
        typer.Argument(metavar="CHANNEL.FIELD...", help="fields, such as cyan1/odometry.x_m or 'cyan*/pose.x_m'"),
    ],
    run: Annotated[
        Path | None,
        typer.Option("--from", metavar="RUN_OR_LOG", help="a run directory, its name, or a log; default: a live run"),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", parser=_picture, metavar="FILE", help="a picture of the recording, .png or .svg"),
    ] = None,
    last: Annotated[
        float, typer.Option(parser=seconds, metavar="SECONDS", help="of a live run: how much of the past is shown")
    ] = 30.0,
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
    chosen: RunChoice = None,
) -> None:
    """Draws fields of messages over time, a diagram for each unit: live in the terminal, or of a recording.

    A recording is drawn with its bookmarks, into the terminal or into a picture.

    Needs: pip install 'fwk[plot]'

    Exit codes: 0 drawn; 1 no run answers; 2 bad input, or the library is missing.
    """
    if out and not run:
        raise typer.BadParameter("--out draws a recording; name it with --from RUN_OR_LOG")
    with failing(BAD_INPUT):
        if not run:
            use_types_of(types)
            _follow(paths, last, chosen)
            return
        log = find_log_with_types(run, types)
        draw = _library("plot", "matplotlib").draw if out else None
        drawn = None if out else _library("terminal_plot", "plotext").drawn
        with progress_of("reading", log) as progress:
            series, notes = series_in(log, paths, progress)
        if out and draw:
            with complete_file(out, force) as part:
                draw(series, notes, part, out.suffix.removeprefix("."), log.name)
    if as_json:
        rows = [{"series": each.label, "unit": each.unit, "values": len(each.values)} for each in series]
        typer.echo(json.dumps({"out": str(out) if out else None, "series": rows}))
    elif drawn:
        say(drawn(series, notes, terminal_width() or _COLUMNS, _ROWS, has_colour()))
    else:
        say(f"{out}: {', '.join(f'{each.label} ({len(each.values)} values)' for each in series)}")


def _follow(paths: list[str], last_s: float, chosen: str | None) -> None:
    """Draws fields of a live run until it ends, or until Ctrl-C.

    Raises:
        LogError: the library is missing, or a path names no number.
    """
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    drawn = _library("terminal_plot", "plotext").drawn
    console = Console()
    if not console.is_terminal:
        raise LogError("a live plot needs a terminal; draw a recording with --from RUN_OR_LOG --out FILE.png")
    with listening(chosen, "plot its recording with --from") as (about, messages), suppress(KeyboardInterrupt):
        made = SeriesOf(about["name"], paths)
        due_us = now_us = 0
        with Live(console=console, auto_refresh=False, screen=True) as live:
            for message in messages:
                now_us = max(now_us, message.time_us)
                if made.is_sought(message.channel) and (found := _decoded(message.data)) is not None:
                    made.add(message.channel, types_of(message.data)[0], found, message.time_us / US_PER_S)
                if monotonic_us() >= due_us:
                    due_us = monotonic_us() + _REDRAW_US
                    made.forget(now_us / US_PER_S - last_s)
                    waiting = f"{about['name']}: no message of {', '.join(paths)} yet; Ctrl-C ends"
                    text = drawn(made.series, [], console.width, console.height - 1, True) if made.series else waiting
                    live.update(Text.from_ansi(text), refresh=True)


def _decoded(data: bytes) -> Any:
    """Returns a message; None, if its type is not known here or it does not decode."""
    try:
        return decoded(data)
    except Exception:  # unknown type, or any error of generated code on broken bytes
        return None


def _library(module: str, library: str) -> Any:
    """Imports a module that needs a library.

    Raises:
        LogError: the library is missing.
    """
    try:
        return import_module(f"fwk.log_tools.{module}")
    except ImportError as error:
        raise LogError(f"{library} is not installed; type: {_INSTALL}") from error

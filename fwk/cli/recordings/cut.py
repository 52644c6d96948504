"""`fwk cut LOG` and `fwk filter LOG`: take a part of a log."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import seconds
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import (
    Channels,
    Exclude,
    Force,
    From,
    Log,
    MessageTypes,
    Out,
    To,
    Types,
    text_of_damage,
)
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json
from fwk.log_tools.cut import cut as cut_log
from fwk.log_tools.selection import Selection
from fwk.program import BAD_INPUT


def cut(
    log: Log,
    out: Out,
    begin: From = "",
    end: To = "",
    last_s: Annotated[
        float | None,
        typer.Option("--last", parser=seconds, metavar="SECONDS", help="the last seconds, also of a run that goes on"),
    ] = None,
    channels: Channels = None,
    exclude: Exclude = None,
    kinds: MessageTypes = None,
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
) -> None:
    """Writes an interval of a log to a new log, with all channels or some of them.

    The plan of a recording stays. `fwk replay` replays the beginning of a recording with all channels, and refuses
    other parts.

    Exit codes: 0 written; 2 bad input, or nothing to write.
    """
    if not (begin or end or last_s):
        raise typer.BadParameter("which interval? use --from, --to or --last; 'fwk filter' takes a whole log")
    if last_s and (begin or end):
        raise typer.BadParameter("--last is an interval of its own; leave out --from and --to")
    _write(log, out, (begin, end, last_s), Selection(channels or (), exclude or (), kinds or ()), force, as_json, types)


def filter(  # noqa: A001 - the name of the command
    log: Log,
    out: Out,
    channels: Channels = None,
    exclude: Exclude = None,
    kinds: MessageTypes = None,
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
) -> None:
    """Writes some channels or types of a log to a new log.

    The plan of a recording stays unless it is excluded; stamps stay with their messages. A filtered recording is not
    replayed.

    Exit codes: 0 written; 2 bad input, or nothing to write.
    """
    selection = Selection(channels or (), exclude or (), kinds or ())
    if selection.is_all:
        raise typer.BadParameter("which messages? use --channels, --exclude or --type")
    _write(log, out, ("", "", None), selection, force, as_json, types)


def _write(
    path: Path,
    out: Path,
    interval: tuple[str, str, float | None],
    selection: Selection,
    force: bool,
    as_json: bool,
    types: Path,
) -> None:
    with failing(BAD_INPUT):
        log = find_log_with_types(path, types)
        with progress_of("reading", log) as progress:
            done = cut_log(log, out, selection, *interval, force, progress)
    if as_json:
        typer.echo(json.dumps({**asdict(done), "log": str(done.log), "out": str(done.out)}))
        return
    left_out = f"; {done.left_out} not selected" if done.left_out else ""
    say(f"{out}: {done.events} events{left_out}", *text_of_damage(done.damaged_bytes))

"""`fwk merge LOG...`: puts several logs into one."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.log_options import Force, Out, text_of_damage
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json
from fwk.log_tools.merge import merge as merge_logs
from fwk.program import BAD_INPUT


def merge(
    logs: Annotated[
        list[Path], typer.Argument(metavar="LOG...", help="logs, or runs by their names or directories, two or more")
    ],
    out: Out,
    align: Annotated[
        bool, typer.Option("--align", help="let all logs begin at 0 s, for logs of different clocks")
    ] = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Writes several logs to one new log, in the order of their time stamps.

    Exit codes: 0 written; 2 bad input.
    """
    if len(logs) < 2:
        raise typer.BadParameter("which logs? name two or more")
    with failing(BAD_INPUT):
        found = [find_log(log) for log in logs]
        with progress_of("reading", *found) as progress:
            done = merge_logs(found, out, align, force, progress)
    if as_json:
        typer.echo(json.dumps({**asdict(done), "logs": list(map(str, done.logs)), "out": str(done.out)}))
        return
    say(f"{out}: {done.events} events of {len(logs)} logs", *text_of_damage(done.damaged_bytes))
    if done.shared_channels:
        say(f"in several logs: {', '.join(done.shared_channels)}")

"""`fwk monitor SCRIPT.py`: a few lines of the user see the messages of a run or of a log."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from fwk.cli.arguments import folder
from fwk.cli.look.public_messages import listening
from fwk.cli.output import BAD_INPUT, FAILED
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import RunChoice
from fwk.lcm.event_log import LogReader
from fwk.model.errors import hint
from fwk.monitor.script import Script, ScriptError, templates


def monitor(
    script: Annotated[Path | None, typer.Argument(metavar="SCRIPT.py", help="Python file with the monitor")] = None,
    log: Annotated[
        Path | None, typer.Option("--from", metavar="RUN_OR_LOG", help="read a recording instead of a live run")
    ] = None,
    template: Annotated[
        str | None, typer.Option(metavar="NAME", help="print a script to start from; 'list' names all of them")
    ] = None,
    count: Annotated[int | None, typer.Option("--count", min=1, metavar="N", help="end after N messages")] = None,
    types: Annotated[
        Path, typer.Option(parser=folder, metavar="FOLDER", help="folder whose lcmtypes/ defines the messages")
    ] = Path(),
    chosen: RunChoice = None,
) -> None:
    """Gives messages to a script: those of a run as they appear on its public bus, or those of a recording.

    The script has `channels`, a tuple of channels or patterns, and a function `message(channel, message, time_us)`;
    if it has a function `end()`, that is called at the end of the run or log, and at Ctrl-C.

    Exit codes: 0 ended; 1 the script fails, or no run answers; 2 bad input.
    """
    if template is not None:
        _print_template(template)
        return
    if script is None:
        _complain("name a script, or print one with --template", BAD_INPUT)
    with failing(BAD_INPUT):
        use_folders([str(types)])
        try:
            made = Script(script)
        except ScriptError as error:
            _complain(error, BAD_INPUT)
        try:
            if log:
                _read(made, find_log_with_types(log, types), count)
            else:
                _listen(made, chosen, count)
            made.end()
        except ScriptError as error:
            _complain(error, FAILED)


def _read(script: Script, log: Path, count: int | None) -> None:
    """Gives the messages of a log to the script, each with its time stamp there."""
    taken = 0
    for event in LogReader(log):
        taken += script.hear(event.channel, event.data, event.time_us)
        if taken == count:
            return


def _listen(script: Script, chosen: str | None, count: int | None) -> None:
    """Gives the messages on the public bus of a run to the script until the run ends, each with its logical time."""
    taken = 0
    with listening(chosen, "monitor its recording with --from") as (_, messages), suppress(KeyboardInterrupt):
        for message in messages:
            taken += script.hear(*message)
            if taken == count:
                return


def _print_template(name: str) -> None:
    known = templates()
    if name == "list":
        for each, text in known.items():
            about = text.splitlines()[0].strip('"')
            typer.echo(f"{each:<10} {about}")
    elif name in known:
        typer.echo(known[name], nl=False)
    else:
        _complain(f"no template '{name}'; {hint(name, list(known))}", BAD_INPUT)


def _complain(error: object, code: int) -> NoReturn:
    typer.echo(f"error: {error}", err=True)
    raise typer.Exit(code)

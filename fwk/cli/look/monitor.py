"""`fwk monitor SCRIPT.py`: a few lines of the user see the messages of a run or of a log."""

import json
from contextlib import redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from fwk.cli.look.public_messages import listening
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import Types
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import Json, RunChoice
from fwk.lcm.event_log import LogReader
from fwk.model.errors import hint
from fwk.monitor.script import Script, ScriptError, templates
from fwk.program import BAD_INPUT, FAILED


def monitor(
    script: Annotated[Path | None, typer.Argument(metavar="SCRIPT.py", help="Python file with the monitor")] = None,
    log: Annotated[
        Path | None, typer.Option("--from", metavar="RUN_OR_LOG", help="read a recording instead of a live run")
    ] = None,
    template: Annotated[
        str | None, typer.Option(metavar="NAME", help="print a script to start from; 'list' names all of them")
    ] = None,
    count: Annotated[int | None, typer.Option("--count", min=1, metavar="N", help="end after N messages")] = None,
    types: Types = Path(),
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Gives messages to a script: those of a run as they appear on its public bus, or those of a recording.

    The script has `channels`, a tuple of channels or patterns, and a function `message(channel, message, time_us)`;
    if it has a function `end()`, that is called at the end of the run or log, and at Ctrl-C.
    `--json` makes each line that the script prints an object: `text`, and `channel` and `time_us` of the message.

    Exit codes: 0 ended; 1 the script fails, or no run answers; 2 bad input.
    """
    if template is not None:
        _print_template(template, as_json)
        return
    if script is None:
        _complain("name a script, or print one with --template", BAD_INPUT)
    with failing(BAD_INPUT):
        use_folders([str(types)])
        try:
            made = LinesAsJson(script) if as_json else Script(script)
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


class LinesAsJson(Script):
    """Script whose printed lines become JSON lines."""

    def hear(self, channel: str, data: bytes, time_us: int) -> bool:
        """Gives a message to the script, and prints its lines with channel and time."""
        with redirect_stdout(StringIO()) as printed:
            wanted = super().hear(channel, data, time_us)
        self._say(printed, channel=channel, time_us=time_us)
        return wanted

    def end(self) -> None:
        """Calls `end` of the script, and prints its lines."""
        with redirect_stdout(StringIO()) as printed:
            super().end()
        self._say(printed)

    def _say(self, printed: StringIO, **about: str | int) -> None:
        say(*(json.dumps({**about, "text": line}) for line in printed.getvalue().splitlines()))


def _print_template(name: str, as_json: bool) -> None:
    known = templates()
    if name == "list":
        found = {each: text.splitlines()[0].strip('"') for each, text in known.items()}
        lines = [f"{each:<10} {about}" for each, about in found.items()]
        say(*([json.dumps(found, indent=2)] if as_json else lines))
    elif name in known:
        typer.echo(known[name], nl=False)
    else:
        _complain(f"no template '{name}'; {hint(name, list(known))}", BAD_INPUT)


def _complain(error: object, code: int) -> NoReturn:
    typer.echo(f"error: {error}", err=True)
    raise typer.Exit(code)

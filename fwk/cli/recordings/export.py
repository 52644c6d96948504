"""`fwk export LOG` and `fwk import FILE`: other formats."""

import json
import os
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import new_file
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log_with_types
from fwk.cli.recordings.log_options import (
    Channels,
    Exclude,
    Force,
    Log,
    MessageTypes,
    Out,
    Types,
    text_of_damage,
)
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json
from fwk.lcm.type_registry import use_types_of
from fwk.log_tools.export import Exported, Format, import_log
from fwk.log_tools.export import export as export_log
from fwk.log_tools.selection import Selection
from fwk.program import BAD_INPUT


def _new_place(text: str) -> Path:
    """Returns the absolute path of a file or folder that can be written; an existing folder is the caller's matter."""
    return Path(text).absolute() if os.path.isdir(text) else new_file(text)


def export(
    log: Log,
    out: Annotated[
        Path,
        typer.Option(
            "--out", "-o", parser=_new_place, metavar="OUT", help="the new file; for csv and parquet a folder"
        ),
    ],
    form: Annotated[
        Format | None, typer.Option("--to", help="format; by default the suffix of OUT says it", show_default=False)
    ] = None,
    channels: Channels = None,
    exclude: Exclude = None,
    kinds: MessageTypes = None,
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
) -> None:
    """Writes the messages of a log as CSV, JSON lines, Parquet or MCAP.

    CSV and Parquet are a folder with a file for each channel. An MCAP file opens in Foxglove, with images, poses,
    markers, transforms and log lines; `fwk import` makes the same log of it. MCAP and Parquet need: pip install
    'fwk[export]'

    Exit codes: 0 written; 2 bad input, or a library is missing.
    """
    chosen = form or next((each for each in Format if out.suffix == f".{each}"), None)
    if chosen is None:
        raise typer.BadParameter(f"which format? use --to {'|'.join(Format)}")
    with failing(BAD_INPUT):
        found = find_log_with_types(log, types)
        with progress_of("exporting", found) as progress:
            selection = Selection(channels or (), exclude or (), kinds or ())
            done = export_log(found, out, chosen, selection, force, progress)
    if as_json:
        typer.echo(json.dumps({**asdict(done), "out": str(done.out), "format": chosen}))
        return
    say(*_lines(done))


def import_(
    file: Annotated[Path, typer.Argument(metavar="FILE.mcap", help="MCAP file, or log of lcm-logger")],
    out: Out,
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
) -> None:
    """Writes an MCAP file, or a log of lcm-logger, to a new log with an index.

    An MCAP file needs messages of LCM types: as JSON with a schema of the type's name, as `fwk export` writes them, or
    as the bytes of LCM. Needs: pip install 'fwk[export]'

    Exit codes: 0 written; 1 some topics are left out, and named; 2 bad input, or a library is missing.
    """
    with failing(BAD_INPUT):
        use_types_of(types)
        done = import_log(file, out, force)
    if as_json:
        typer.echo(json.dumps({**asdict(done), "out": str(done.out)}))
    else:
        say(f"{out}: {done.events} events", *(f"left out: {topic}: {why}" for topic, why in done.left_out.items()))
    if done.left_out:
        raise typer.Exit(1)


def _lines(done: Exported) -> list[str]:
    views = f", and {done.views} of Foxglove's types" if done.views else ""
    made = [f"{done.out}: {done.messages} messages{views}", *text_of_damage(done.damaged_bytes)]
    return made + [f"{channel}: {count} messages do not decode" for channel, count in done.undecodable.items()]

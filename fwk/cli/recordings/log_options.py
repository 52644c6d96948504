"""Options shared by the commands that read logs or make new files of them."""

from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import folder, new_file

Log = Annotated[Path, typer.Argument(metavar="LOG", help="log, or run by its name or directory")]
Out = Annotated[Path, typer.Option("--out", "-o", parser=new_file, metavar="FILE", help="the new log")]
Force = Annotated[bool, typer.Option("--force", help="replace FILE if it exists")]
Types = Annotated[
    Path,
    typer.Option("--types", parser=folder, metavar="FOLDER", help="folder whose lcmtypes/ defines the messages"),
]
Channels = Annotated[
    list[str] | None,
    typer.Option("--channels", metavar="PATTERN", help="only these channels, such as 'cyan1/*'; repeatable"),
]
Exclude = Annotated[
    list[str] | None, typer.Option("--exclude", metavar="PATTERN", help="all but these channels; repeatable")
]
MessageTypes = Annotated[
    list[str] | None, typer.Option("--type", metavar="PATTERN", help="only messages of these types; repeatable")
]
From = Annotated[
    str, typer.Option("--from", metavar="MOMENT", help="begin at a tick (1200), a time (12.5s) or a 'fwk note'")
]
To = Annotated[str, typer.Option("--to", metavar="MOMENT", help="end after this tick, time or 'fwk note'")]


def text_of_damage(damaged_bytes: int) -> list[str]:
    """Returns the line about damage of a log; none without damage."""
    return [f"{damaged_bytes} damaged bytes skipped"] if damaged_bytes else []

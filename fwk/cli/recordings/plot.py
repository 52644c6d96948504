"""`fwk plot CHANNEL.FIELD... --from RUN`: draws values of a recording over time."""

import json
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import new_file
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.log_options import Force, Types
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import BAD_INPUT, Json
from fwk.lcm.event_log import LogError
from fwk.lcm.type_registry import use_types_of
from fwk.log_tools.new_file import new_file as complete_file
from fwk.log_tools.series import series_in

_FORMATS = ("png", "svg")
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
    run: Annotated[Path, typer.Option("--from", metavar="RUN_OR_LOG", help="a run directory, its name, or a log")],
    out: Annotated[
        Path, typer.Option("--out", "-o", parser=_picture, metavar="FILE", help="the picture, .png or .svg")
    ],
    force: Force = False,
    as_json: Json = False,
    types: Types = Path(),
) -> None:
    """Draws fields of recorded messages over time, a diagram for each unit, with the bookmarks of the run.

    Needs: pip install 'fwk[plot]'

    Exit codes: 0 drawn; 2 bad input, or the library is missing.
    """
    with failing(BAD_INPUT):
        use_types_of(types)
        log = find_log(run)
        try:
            from fwk.log_tools.plot import draw
        except ImportError as error:
            raise LogError(f"matplotlib is not installed; type: {_INSTALL}") from error
        with progress_of("reading", log) as progress:
            series, notes = series_in(log, paths, progress)
        with complete_file(out, force) as part:
            draw(series, notes, part, out.suffix.removeprefix("."), log.name)
    if as_json:
        rows = [{"series": each.label, "unit": each.unit, "values": len(each.values)} for each in series]
        typer.echo(json.dumps({"out": str(out), "series": rows}))
        return
    say(f"{out}: {', '.join(f'{each.label} ({len(each.values)} values)' for each in series)}")

"""`fwk video LOG -o FILE.mp4`: a recording to look at."""

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.logs import failing, find_log
from fwk.plan.model import Plan
from fwk.record.types import use_types_of
from fwk.record.video import VideoError, drawing, render_video

PLAN_FILE = "plan.json"


def video(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="log or run directory")],
    out: Annotated[Path, typer.Option("--out", "-o", help="where the video goes: FILE.mp4")],
    draw: Annotated[str, typer.Option(help="module:function that draws; by default the launch file's 'video'")] = "",
    types: Annotated[Path, typer.Option(help="folder whose lcmtypes/ the messages are of")] = Path(),
) -> None:
    """Draws a recording into an mp4 video."""
    if out.suffix != ".mp4":
        raise typer.BadParameter(f"{out}: only .mp4 is written; say {out.with_suffix('.mp4')}")
    with failing(2):
        use_types_of(types)
        file = find_log(log)
        sys.path.append(str(types.resolve()))
        try:
            pictures = render_video(file, out, drawing(draw or _drawing_of_run(file)))
        except VideoError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(1) from error
    typer.echo(f"{out}: {pictures} pictures")


def _drawing_of_run(log: Path) -> str:
    """What the launch file of the recorded run names; its folders become importable."""
    file = log.parent / PLAN_FILE
    try:
        plan = Plan.from_json(json.loads(file.read_text()))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise VideoError(
            f"{log}: no readable {PLAN_FILE} of its run beside it; name the drawing with --draw"
        ) from error
    if not plan.video:
        raise VideoError(f"{plan.file}: names no drawing ('video: module:function'); name one with --draw")
    sys.path.extend(plan.folders)
    return plan.video

"""`fwk video LOG -o FILE.mp4`: a recording to look at."""

from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import folder, video_file
from fwk.cli.recordings.find_log import failing, find_log
from fwk.lcm.type_registry import put_first, use_types_of
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.video import VideoError, drawing, render_video


def video(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="log or run directory")],
    out: Annotated[
        Path, typer.Option("--out", "-o", parser=video_file, metavar="FILE.mp4", help="where the video goes")
    ],
    draw: Annotated[str, typer.Option(help="module:function that draws; by default the launch file's 'video'")] = "",
    types: Annotated[
        Path, typer.Option(parser=folder, metavar="FOLDER", help="whose lcmtypes/ the messages are of")
    ] = Path(),
) -> None:
    """Draws a recording into an mp4 video."""
    with failing(2):
        use_types_of(types)
        file = find_log(log)
        put_first([str(types.resolve())])
        try:
            pictures = render_video(file, out, drawing(draw or _drawing_of_run(file)))
        except VideoError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(1) from error
    typer.echo(f"{out}: {pictures} pictures")


def _drawing_of_run(log: Path) -> str:
    """What the launch file of the recorded run names; its folders become importable."""
    try:
        plan = Recording(log).plan
    except RecordingError as error:
        raise VideoError(f"{log}: no readable plan of its run in it; name the drawing with --draw") from error
    if not plan.video:
        raise VideoError(f"{plan.file}: names no drawing ('video: module:function'); name one with --draw")
    for folder_of_run in plan.folders:
        use_types_of(Path(folder_of_run))
    put_first(plan.folders)
    return plan.video

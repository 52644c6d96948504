"""`fwk video LOG -o FILE.mp4`: draws a recording into a video."""

import json
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import video_file
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.log_options import Types
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run.rendering import render, report
from fwk.cli.run_options import Json
from fwk.program import BAD_INPUT, INTERRUPTED
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.video import VideoError, drawing


def video(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="log, or run by its name or directory")],
    out: Annotated[
        Path, typer.Option("--out", "-o", parser=video_file, metavar="FILE.mp4", help="where the video goes")
    ],
    draw: Annotated[str, typer.Option(help="module:function that draws; by default the launch file's 'video'")] = "",
    types: Types = Path(),
    as_json: Json = False,
) -> None:
    """Draws a recording into an mp4 video, as H.264 or VP9 where available, else as MPEG-4 part 2.

    Exit codes: 0 drawn; 1 it cannot be drawn; 2 bad input. Ctrl-C leaves a video of the pictures until then.
    """
    with failing(BAD_INPUT):
        use_folders([str(types)])
        file = find_log(log)
        try:
            made = render(file, out, drawing(draw or _drawing_of_run(file)))
        except VideoError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(1) from error
        except KeyboardInterrupt as interrupt:
            raise typer.Exit(INTERRUPTED) from interrupt
    if as_json:
        about = {"file": str(out), "pictures": made.pictures, "codec": made.codec}
        typer.echo(json.dumps(about))
        return
    for line in report(out, made):
        typer.echo(line)


def _drawing_of_run(log: Path) -> str:
    """Returns the drawing that the recorded plan names; makes the folders of its run importable."""
    try:
        plan = Recording(log).plan
    except RecordingError as error:
        raise VideoError(f"{log}: no readable plan of its run in it; name the drawing with --draw") from error
    if not plan.video:
        raise VideoError(f"{plan.file}: names no drawing ('video: module:function'); name one with --draw")
    use_folders(plan.folders)
    return plan.video

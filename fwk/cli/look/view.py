"""`fwk view`: shows a run or a recording in Rerun."""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from fwk.cli.arguments import folder, new_file
from fwk.cli.look.public_messages import listening
from fwk.cli.output import BAD_INPUT, say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.progress import progress_of
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import RunChoice
from fwk.clock import sleep_s
from fwk.lcm.log_parts import uncompressed_name
from fwk.recording.compare import plan_in

if TYPE_CHECKING:
    from fwk.web.rerun_feed import RerunFeed

INSTALL = "pip install 'fwk[view]'"
PORT = 9876
_WAIT_S = 3600.0
_SUFFIX = ".rrd"


def _stream_file(text: str) -> Path:
    """Returns the absolute path of a new file of Rerun.

    Raises:
        BadParameter: the suffix is another.
    """
    if Path(text).suffix != _SUFFIX:
        raise typer.BadParameter(f"'{text}' is not a file of Rerun; use a name such as run{_SUFFIX}")
    return new_file(text)


def view(
    log: Annotated[
        Path | None, typer.Option("--from", metavar="RUN_OR_LOG", help="show a recording instead of a live run")
    ] = None,
    save: Annotated[
        Path | None, typer.Option(parser=_stream_file, metavar="FILE.rrd", help="write a file for Rerun; no viewer")
    ] = None,
    web: Annotated[bool, typer.Option("--web", help="in the browser, also without a screen here")] = False,
    port: Annotated[
        int, typer.Option(min=1, max=65534, metavar="N", help="port of the stream; the web page has the next one")
    ] = PORT,
    channels: Annotated[
        list[str] | None,
        typer.Option("--channels", metavar="PATTERN", help="only these channels, such as 'cyan1/*'; repeatable"),
    ] = None,
    views: Annotated[
        list[str] | None,
        typer.Option("--view", metavar="MODULE", help="a further module with views of the project; repeatable"),
    ] = None,
    types: Annotated[
        Path, typer.Option(parser=folder, metavar="FOLDER", help="folder whose lcmtypes/ defines the messages")
    ] = Path(),
    chosen: RunChoice = None,
) -> None:
    """Shows a live run or a recording in Rerun: positions, images, scans, plots and log lines, tick by tick.

    Views that the project adds to the console are drawn, too. Without a screen the viewer is a web page.

    Needs: pip install 'fwk[view]'

    Exit codes: 0 ended; 1 no run answers; 2 bad input, or the library is missing.
    """
    with failing(BAD_INPUT):
        use_folders([str(types)])
        try:
            from fwk.web.rerun_feed import RerunFeed, ViewError
        except ImportError as error:
            _complain(f"Rerun is not installed; type: {INSTALL}", BAD_INPUT, error)
        if log:
            found = find_log(log)
            plan = plan_in(found)
            use_folders(plan.folders if plan else [])
            name = found.parent.name if uncompressed_name(found).name == "log.lcm" else found.name
        try:
            if log:
                feed = RerunFeed(name, channels or (), views or (), types)
                end = _opened(feed, save, web, port)
                with progress_of("reading", found) as progress:
                    feed.read(found, progress)
            else:
                with listening(chosen, "show its recording with --from") as (about, messages):
                    feed = RerunFeed(about["name"], channels or (), views or (), types, about["pid"])
                    end = _opened(feed, save, web, port)
                    with suppress(KeyboardInterrupt):
                        feed.follow(messages)
        except ViewError as error:
            _complain(str(error), BAD_INPUT, error)
    feed.close()
    end()


def _opened(feed: "RerunFeed", save: Path | None, web: bool, port: int) -> Callable[[], None]:
    """Begins the output; returns what is to be done at its end."""
    if save:
        feed.save(save)
        return lambda: say(f"{save}: open it with: rerun {save}")
    if web or not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        say(f"Rerun: {feed.serve(port)}; Ctrl-C ends")
        return _wait
    feed.spawn(port)
    return lambda: None


def _wait() -> None:
    """Waits for Ctrl-C."""
    with suppress(KeyboardInterrupt):
        while True:
            sleep_s(_WAIT_S)


def _complain(text: str, code: int, error: Exception) -> NoReturn:
    typer.echo(f"error: {text}", err=True)
    raise typer.Exit(code) from error

"""`fwk view`: shows a run or a recording in Rerun."""

import errno
import json
import os
import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from fwk.cli.arguments import new_file
from fwk.cli.look.public_messages import listening
from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.log_options import Channels, Types
from fwk.cli.recordings.progress import progress_of
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import Json, RunChoice
from fwk.clock import sleep_s
from fwk.lcm.log_parts import uncompressed_name
from fwk.program import BAD_INPUT, FAILED
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
    channels: Channels = None,
    views: Annotated[
        list[str] | None,
        typer.Option("--view", metavar="MODULE", help="a further module with views of the project; repeatable"),
    ] = None,
    types: Types = Path(),
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows a live run or a recording in Rerun: positions, images, scans, plots and log lines, tick by tick.

    Views that the project adds to the console are drawn, too. Without a screen the viewer is a web page.
    `--json` prints one object: name of the run, and file, or addresses of page and stream.

    Needs: pip install 'fwk[view]'

    Exit codes: 0 ended; 1 no run answers, or a port is taken; 2 bad input, or the library is missing.
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
                end = _opened(feed, name, save, web, port, as_json)
                _read(feed, found, shown=save is None)
            else:
                with listening(chosen, "show its recording with --from") as (about, messages):
                    feed = RerunFeed(about["name"], channels or (), views or (), types, about["pid"])
                    end = _opened(feed, about["name"], save, web, port, as_json)
                    with suppress(KeyboardInterrupt):
                        feed.follow(messages)
        except ViewError as error:
            _complain(str(error), BAD_INPUT, error)
    feed.close()
    end()


def _opened(feed: "RerunFeed", name: str, save: Path | None, web: bool, port: int, as_json: bool) -> Callable[[], None]:
    """Begins the output; returns what is to be done at its end."""
    if save:
        feed.save(save)
        saved = {"name": name, "file": str(save)}
        return lambda: say(json.dumps(saved) if as_json else f"{save}: open it with: rerun {save}")
    if web or not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        _check_free(port, port + 1)
        page = feed.serve(port)
        served = {"name": name, "page": page, "stream": page.partition("?url=")[2]}
        say(json.dumps(served) if as_json else f"Rerun: {page}; Ctrl-C ends")
        return _wait
    feed.spawn(port)
    if as_json:
        say(json.dumps({"name": name, "port": port}))
    return lambda: None


def _read(feed: "RerunFeed", log: Path, shown: bool) -> None:
    """Reads a log into the feed; Ctrl-C ends a command that only shows it. A file would lack the rest."""
    try:
        with progress_of("reading", log) as progress:
            feed.read(log, progress)
    except KeyboardInterrupt as interrupt:
        if not shown:
            raise
        raise typer.Exit(0) from interrupt


def _check_free(*ports: int) -> None:
    """Ends the command if another program has one of the ports, of which Rerun would only write a log line."""
    for port in ports:
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("0.0.0.0", port))
            except OSError as error:
                reason = "is taken" if error.errno == errno.EADDRINUSE else f"cannot be opened: {error.strerror}"
                _complain(f"port {port} {reason}; choose another with --port", FAILED, error)


def _wait() -> None:
    """Waits for Ctrl-C."""
    with suppress(KeyboardInterrupt):
        while True:
            sleep_s(_WAIT_S)


def _complain(text: str, code: int, error: Exception) -> NoReturn:
    typer.echo(f"error: {text}", err=True)
    raise typer.Exit(code) from error

"""Draws the pictures of the documentation from a recording: the match, and the live display of the run.

`make pictures` records a match and calls this program.
"""

import argparse
import re
from collections.abc import Iterator
from io import StringIO
from pathlib import Path

import cv2
from rich.console import Console
from rich.terminal_theme import MONOKAI

from fwk.cli.recordings.user_folders import use_folders
from fwk.display.screen import screen
from fwk.display.view import STATUS_CHANNEL, View
from fwk.lcm import messages
from fwk.lcm.log_file import LogError
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import header_of
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.video import drawing
from lcmtypes.core import status_t

_DOCS = Path(__file__).parents[2] / "docs"
_COLUMNS, _ROWS = 120, 36
_FONTS = re.compile(r"@font-face \{.*?\}\s*", re.S)  # files on other machines


def main() -> None:
    """Writes docs/match.png and docs/display.svg."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("log", type=Path, help="recording of a match")
    parser.add_argument("--tick", type=int, default=1_000_000, help="the tick to draw; default: the last")
    arguments = parser.parse_args()
    try:
        plan = Recording(arguments.log).plan
    except (LogError, RecordingError) as error:
        parser.error(str(error))
    use_folders(plan.folders)
    view = View(plan)
    for packet in packets(arguments.log, arguments.tick):
        view.take(packet)
    (_DOCS / "display.svg").write_text(display(view, f"fwk-launch {Path(plan.file).name}"))
    picture = drawing(plan.video)(view.newest)
    if picture is not None:
        cv2.imwrite(str(_DOCS / "match.png"), picture)


def packets(log: Path, last_tick: int) -> Iterator[bytes]:
    """Yields the messages of a recording as a display gets them, until a component's message is beyond the last tick.

    A status beyond it is left out: the supervisor writes one now and then in real time.
    """
    for event in StampedLog(log):
        data = event.data
        if event.channel == STATUS_CHANNEL:
            status = messages.decode(status_t, data, event.channel)
            if status.tick > last_tick:
                continue
            for host in status.hosts:
                host.pid = 0  # of an ended process, whose number may belong to another one now
            data = status.encode()
        elif not event.channel.startswith("fwk/") and (head := header_of(data)) and head.tick > last_tick:
            return
        yield event.channel.encode() + b"\0" + data


def display(view: View, title: str) -> str:
    """Returns the live display as an SVG picture that needs no other file."""
    console = Console(record=True, width=_COLUMNS, file=StringIO(), color_system="truecolor", force_terminal=True)
    console.print(screen(view, _ROWS, _COLUMNS, keys=True))
    picture = console.export_svg(title=title, theme=MONOKAI, unique_id="display")
    return _FONTS.sub("", picture)


if __name__ == "__main__":
    main()

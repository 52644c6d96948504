"""Draws a recording into a video, with progress; Ctrl-C leaves a video that can be played."""

import sys
from pathlib import Path

from fwk.clock import US_PER_S, monotonic_us
from fwk.recording.video import Draw, Rendered, render_video
from fwk.recording.video_encoder import advice

_TERMINAL_US, _FILE_US = US_PER_S // 4, 10 * US_PER_S


class Progress:
    """Prints how far the drawing is: in one line of a terminal, else in a line every ten seconds."""

    def __init__(self) -> None:
        self._live = sys.stderr is not None and sys.stderr.isatty()
        self._period_us = _TERMINAL_US if self._live else _FILE_US
        self._due_us = monotonic_us() + self._period_us
        self.pictures = 0

    def __call__(self, pictures: int, time_s: float) -> None:
        self.pictures = pictures
        if monotonic_us() >= self._due_us:
            self._due_us = monotonic_us() + self._period_us
            print(f"drawing: {pictures} pictures, {time_s:.1f} s", end="\r" if self._live else "\n", file=sys.stderr)

    def end(self) -> None:
        """Clears the line of a terminal."""
        if self._live:
            print("\x1b[K", end="", file=sys.stderr)


def render(log: Path, out: Path, draw: Draw) -> Rendered:
    """Draws a recording into a file.

    Raises:
        KeyboardInterrupt: interrupted; a line on stderr says how many pictures the video holds.
        VideoError, LogError: the video cannot be made.
    """
    progress = Progress()
    try:
        return render_video(log, out, draw, progress)
    except KeyboardInterrupt:
        progress.end()
        print(f"{out}: interrupted, {progress.pictures} pictures are in it", file=sys.stderr)
        raise
    finally:
        progress.end()


def report(out: Path, made: Rendered) -> list[str]:
    """Returns the lines that describe a video."""
    note = advice(made.codec)
    return [f"{out}, {made.pictures} pictures, {made.codec}", *([note] if note else [])]

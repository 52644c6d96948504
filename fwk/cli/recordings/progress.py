"""Progress bar of commands that read whole logs."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from fwk.lcm.log_file import LogError
from fwk.lcm.log_parts import LogBytes

_SMALL_BYTES = 20 << 20  # read within a moment

Progress = Callable[[int], None]
"""Takes the number of bytes done so far."""


@contextmanager
def progress_of(verb: str, *logs: Path) -> Iterator[Progress]:
    """Shows a bar on a terminal while large logs are read; the bar disappears at the end."""
    total = sum(map(_size_bytes, logs))
    if total < _SMALL_BYTES or not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, DownloadColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = TextColumn(f"{verb} {logs[0].name}"), BarColumn(), DownloadColumn(), TimeRemainingColumn()
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(verb, total=total)
        yield lambda done: bar.update(task, completed=done)


def _size_bytes(file: Path) -> int:
    """Returns the size of a log with all its parts, or of another file; 0 if it cannot be read."""
    try:
        with LogBytes(file) as log:
            return log.size_bytes
    except LogError:
        return 0

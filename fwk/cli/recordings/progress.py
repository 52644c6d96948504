"""Progress bar of commands that read whole logs."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

_SMALL_BYTES = 20 << 20  # read within a moment

Progress = Callable[[int], None]
"""Takes the number of bytes done so far."""


@contextmanager
def progress_of(verb: str, *logs: Path) -> Iterator[Progress]:
    """Shows a bar on a terminal while large logs are read; the bar disappears at the end."""
    total = sum(os.path.getsize(log) for log in logs if os.path.isfile(log))
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

"""New files that appear under their names only when they are complete."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from fwk.lcm.event_log import LogError
from fwk.recording.indexed_log import IndexedLogWriter
from fwk.recording.log_index import index_path


@contextmanager
def new_file(path: Path, replace: bool) -> Iterator[Path]:
    """Gives a temporary name beside `path` to write to, and renames the file at the end; an error leaves no file.

    Raises:
        LogError: the file exists and `replace` is false, or it cannot be written.
    """
    if path.exists() and not replace:
        raise LogError(f"{path}: exists already; choose another name, or replace it with --force")
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        os.replace(part, path)
    except OSError as error:
        raise LogError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)


@contextmanager
def new_log(path: Path, replace: bool) -> Iterator[IndexedLogWriter]:
    """Opens a new log, which gets an index.

    Raises:
        LogError: the file exists and `replace` is false, cannot be written, or would hold no event.
    """
    with new_file(path, replace) as part:
        index = index_path(part)
        try:
            with IndexedLogWriter(part, _fail) as log:
                yield log
            if not log.events:
                raise LogError(f"{path}: not written: no event would be in it")
            index_path(path).unlink(missing_ok=True)
            if index.exists():
                os.replace(index, index_path(path))
        finally:
            index.unlink(missing_ok=True)


def _fail(text: str) -> NoReturn:
    """Ends the work when the disk is full; a recording would go on without messages."""
    raise LogError(text)

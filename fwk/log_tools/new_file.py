"""New files that appear under their names only when they are complete."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from fwk.lcm.event_log import LogError
from fwk.lcm.log_parts import exists, remove_parts
from fwk.recording.indexed_log import IndexedLogWriter
from fwk.recording.log_index import index_path


@contextmanager
def new_file(path: Path, replace: bool) -> Iterator[Path]:
    """Gives a temporary name beside `path` to write to, and renames it at the end; an error leaves nothing there.

    A folder can be written as well. A folder with files in it is never replaced, nor are pipes and devices.

    Raises:
        LogError: the file exists and `replace` is false, or it cannot be written.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise LogError(f"{path}: not an ordinary file; choose another name")
    if path.is_dir() and any(path.iterdir()):
        raise LogError(f"{path}: a folder with files in it; choose another name, or remove it")
    if path.exists() and not path.is_dir() and not replace:
        raise LogError(f"{path}: exists already; choose another name, or replace it with --force")
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        os.replace(part, path)
    except OSError as error:
        raise LogError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if part.is_dir():
            shutil.rmtree(part)
        part.unlink(missing_ok=True)


@contextmanager
def new_log(path: Path, replace: bool) -> Iterator[IndexedLogWriter]:
    """Opens a new log, which gets an index.

    Raises:
        LogError: the file exists and `replace` is false, cannot be written, or would hold no event.
    """

    def fail(_: str) -> NoReturn:
        """Ends the work; a recording would go on without messages."""
        raise LogError(f"{path}: cannot be written: the disk is full, or failed")

    if exists(path) and not replace:
        raise LogError(f"{path}: exists already; choose another name, or replace it with --force")
    with new_file(path, replace) as part:
        index = index_path(part)
        try:
            with IndexedLogWriter(part, fail) as log:
                yield log
            if not log.events:
                raise LogError(f"{path}: not written: no event would be in it")
            remove_parts(path)  # of the log that is replaced
            index_path(path).unlink(missing_ok=True)
            if index.exists():
                os.replace(index, index_path(path))
        finally:
            index.unlink(missing_ok=True)

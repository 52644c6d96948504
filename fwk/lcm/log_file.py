"""Opens one file of a log, plain or compressed, for reading at any position."""

import fcntl
import os
import stat
from pathlib import Path
from typing import Protocol

from fwk.lcm.seekable_zstd import INSTALL, SUFFIX, CompressedFile, CompressedFileError, library


class LogError(Exception):
    """A log cannot be opened or holds nothing usable; the text names the file and the reason."""


class LogFile(Protocol):
    """File whose bytes can be read at any position."""

    size_bytes: int
    mtime_ns: int

    def read(self, position: int, size: int) -> bytes:
        """Returns up to `size` bytes."""

    def close(self) -> None:
        """Closes the file."""


def opened(path: Path) -> LogFile:
    """Opens a file of a log, or its compressed form if that has taken its place.

    Raises:
        LogError: neither exists, is an ordinary file, or can be read.
    """
    form = path
    try:
        try:
            return _form_of(form)
        except FileNotFoundError:
            form = path.with_name(path.name + SUFFIX)
            if not os.path.exists(form):
                form = path
                raise
            return _form_of(form)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise LogError(f"{form}: cannot read: {reason}") from error
    except CompressedFileError as error:
        raise LogError(f"{form}: cannot read: {error}") from error


def _form_of(path: Path) -> LogFile:
    if not stat.S_ISREG(os.stat(path).st_mode):  # opening a pipe would wait for its other end
        raise LogError(f"{path}: not an ordinary file")
    return CompressedFile(path) if is_compressed(path) else _PlainFile(path)


class _PlainFile:
    """An ordinary file."""

    def __init__(self, path: Path) -> None:
        self._descriptor = os.open(path, os.O_RDONLY)
        found = os.fstat(self._descriptor)
        self.size_bytes, self.mtime_ns = found.st_size, found.st_mtime_ns

    def read(self, position: int, size: int) -> bytes:
        """Returns up to `size` bytes."""
        return os.pread(self._descriptor, size, position)

    def close(self) -> None:
        """Closes the file."""
        os.close(self._descriptor)


def existing(path: Path) -> Path | None:
    """Returns the file or its compressed form; None if neither exists."""
    return next((form for form in (path, path.with_name(path.name + SUFFIX)) if os.path.exists(form)), None)


def is_compressed(path: Path) -> bool:
    """Returns whether a file of a log is compressed."""
    return path.name.endswith(SUFFIX)


def check_compression() -> None:
    """Checks that logs can be compressed here.

    Raises:
        LogError: the library is missing.
    """
    try:
        library()
    except CompressedFileError as error:
        raise LogError(f"compressed recordings need another library: {INSTALL}") from error


def locked(descriptor: int, lock: int) -> bool:
    """Takes a lock on an open file of a log until it is closed; a writer has a shared one.

    Args:
        descriptor: the open file.
        lock: `fcntl.LOCK_SH` or `fcntl.LOCK_EX`.

    Returns:
        whether no other process has a lock that excludes this one; True where the file system has no locks.
    """
    try:
        fcntl.flock(descriptor, lock | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True

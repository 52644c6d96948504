"""Files of one log: it may be split into numbered parts, and each part may be compressed.

The parts are `log.lcm`, `log.lcm.01`, `log.lcm.02` and so on. Each is a log of its own; the numbers of its events
continue those of the part before, so a log of another program with such a name is not taken for a part.
"""

import fcntl
import os
import re
import stat
import struct
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from fwk.lcm.seekable_zstd import INSTALL, SUFFIX, CompressedFile, CompressedFileError, library

SYNC = (0xEDA1DA01).to_bytes(4, "big")
"""First bytes of each event."""
_NUMBER = struct.Struct(">4sq")  # sync word and number of an event
_LATER_PART = re.compile(r"(.+)\.\d{2,}")


class LogError(Exception):
    """A log cannot be opened or holds nothing usable; the text names the file and the reason."""


class _File(Protocol):
    """File whose bytes can be read at any position."""

    size_bytes: int
    mtime_ns: int

    def read(self, position: int, size: int) -> bytes:
        """Returns up to `size` bytes."""

    def close(self) -> None:
        """Closes the file."""


class LogBytes:
    """The bytes of all parts of a log, one after another. What is appended later is not part of them.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._paths = list(map(uncompressed_name, parts_of(path)))  # a part may be compressed while others are read
        self._open: tuple[int, _File] | None = None
        self._ends: list[int] = []
        self.mtime_ns = 0
        """Time at which the newest part was written, by its file system."""
        end = 0
        for number in range(len(self._paths)):
            part = self._part(number)
            end += part.size_bytes
            self._ends.append(end)
            self.mtime_ns = max(self.mtime_ns, part.mtime_ns)
        self.size_bytes = end
        """Size of all parts together, uncompressed."""

    def read(self, position: int, size: int) -> bytes:
        """Returns the bytes from a position on; fewer than `size` at the end of the log."""
        begin, found = 0, b""
        for number, end in enumerate(self._ends):
            if begin <= position < end and size > 0:
                data = self._part(number).read(position - begin, min(size, end - position))
                if not data:  # the file shrank while it was read
                    break
                found = found + data if found else data
                position += len(data)
                size -= len(data)
            begin = end
        return found

    def close(self) -> None:
        """Closes the part that is open."""
        if self._open:
            self._open[1].close()
            self._open = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _part(self, number: int) -> _File:
        if self._open is None or self._open[0] != number:
            self.close()
            self._open = number, _opened_form(self._paths[number])
        return self._open[1]


def parts_of(path: Path) -> list[Path]:
    """Returns the files of a log, of which each but the first continues the one before.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """
    first = _existing(path)
    if first is None:
        _opened(path)  # raises with the reason
    found = [first or path]
    base = uncompressed_name(path)
    while (later := _existing(part_path(base, len(found)))) and _continues(later):
        found.append(later)
    return found


def part_path(log: Path, number: int) -> Path:
    """Returns the path of a part: `log.lcm.01` for the part after the first one, which has the name of the log."""
    return log.with_name(f"{log.name}.{number:02}") if number else log


def uncompressed_name(path: Path) -> Path:
    """Returns the path without the suffix of a compressed file."""
    return path.with_name(path.name.removesuffix(SUFFIX)) if path.name != SUFFIX else path


def is_later_part(path: Path) -> bool:
    """Returns whether a file is a part of a log that begins in another file."""
    matched = _LATER_PART.fullmatch(uncompressed_name(path).name)
    return matched is not None and exists(path.with_name(matched[1])) and _continues(path)


def is_log(path: Path) -> bool:
    """Returns whether a file begins as a log does; a compressed file counts as one.

    Raises:
        LogError: the file cannot be read.
    """
    return is_compressed(path) or _head(path).startswith(SYNC)


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


def exists(log: Path) -> bool:
    """Returns whether the first file of a log exists, compressed or not."""
    return _existing(log) is not None


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


def remove_parts(log: Path) -> None:
    """Removes the parts of a log behind the first one, and a compressed first one.

    Raises:
        OSError: a file cannot be removed.
    """
    number = 1
    while (later := _existing(part_path(log, number))) and _continues(later):
        later.unlink()
        number += 1
    log.with_name(log.name + SUFFIX).unlink(missing_ok=True)


def _existing(path: Path) -> Path | None:
    """Returns the file or its compressed form; None if neither exists."""
    return next((form for form in (path, path.with_name(path.name + SUFFIX)) if os.path.exists(form)), None)


def _continues(path: Path) -> bool:
    """Returns whether the first event in a file is not the first one of its log; so it is in a compressed part."""
    if is_compressed(path):
        return True
    try:
        head = _head(path)
    except LogError:
        return not os.path.exists(path) and exists(path)  # compressed in this moment
    return len(head) == _NUMBER.size and head.startswith(SYNC) and _NUMBER.unpack(head)[1] > 0


def _head(path: Path) -> bytes:
    file = _opened(path)
    try:
        return file.read(0, _NUMBER.size)
    finally:
        file.close()


def _opened_form(path: Path) -> _File:
    """Opens a file or its compressed form, also if the one replaces the other in this moment."""
    try:
        return _opened(_existing(path) or path)
    except LogError:
        if os.path.exists(path) or not exists(path):
            raise
        return _opened(path.with_name(path.name + SUFFIX))


def _opened(path: Path) -> _File:
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise LogError(f"{path}: not an ordinary file")
        return CompressedFile(path) if is_compressed(path) else _PlainFile(path)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise LogError(f"{path}: cannot read: {reason}") from error
    except CompressedFileError as error:
        raise LogError(f"{path}: cannot read: {error}") from error


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

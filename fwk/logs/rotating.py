"""Text files of bounded size and number: written line by line, read to their end or for as long as they grow."""

import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from fwk.clock import sleep_s
from fwk.lcm.disk import has_room

_LOOK_S = 0.2
_CHUNK = 1 << 20


class RotatingFile:
    """Appends whole lines. A full file `log` becomes `log.1`, that `log.2`; of more than `files` the oldest is removed.

    While the disk is full, lines are left out; `report` gets a text when that begins and when it ends. A deleted file
    is begun again, and reported.
    """

    def __init__(self, path: Path, max_bytes: int, files: int, report: Callable[[str], None]) -> None:
        self._path = path
        self._max_bytes = max_bytes
        self._files = names(path, files)
        self._report = report
        self._descriptor = -1
        self._bytes = 0
        self._left_out = 0
        with suppress(OSError):  # the first line reports the reason
            self._open()

    def write(self, line: str) -> None:
        """Adds a line."""
        if self._left_out and not has_room(self._path):
            self._left_out += 1
            return
        try:
            self._append(line.encode(errors="backslashreplace") + b"\n")
        except OSError as error:
            self._left_out += 1
            if self._left_out == 1:
                self._report(f"{self._path}: cannot log there: {error.strerror}; the run goes on, lines are missing")
            return
        if self._left_out:
            missing, self._left_out = self._left_out, 0
            self._report(f"{self._path}: the disk has room again; {missing} lines are missing")

    def close(self) -> None:
        """Closes the file; a later line opens it again."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _append(self, data: bytes) -> None:
        if self._descriptor >= 0 and not os.fstat(self._descriptor).st_nlink:
            self.close()
            self._report(f"{self._path}: was deleted; a new file begins here, the lines before are lost")
        if self._descriptor < 0:
            self._open()
        if self._bytes and self._bytes + len(data) > self._max_bytes:
            self._rotate()
        try:
            rest = data
            while rest:
                rest = rest[os.write(self._descriptor, rest) :]
        except OSError:
            os.ftruncate(self._descriptor, self._bytes)  # removes a torn line
            raise
        self._bytes += len(data)

    def _open(self) -> None:
        self._descriptor = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
        self._bytes = os.fstat(self._descriptor).st_size

    def _rotate(self) -> None:
        for older, newer in zip(self._files, self._files[1:], strict=False):
            if newer.exists():
                os.replace(newer, older)
        if len(self._files) == 1:
            self._path.unlink()
        self.close()
        self._open()


def names(path: Path, files: int) -> list[Path]:
    """Returns the paths of a log of this number of files, the oldest first."""
    return [*(path.with_name(f"{path.name}.{number}") for number in range(files - 1, 0, -1)), path]


def read_rotating(path: Path, goes_on: Callable[[], bool] = lambda: False) -> Iterator[str]:
    """Yields the whole lines of all files of a log, the oldest first; waits for more while `goes_on()` is true.

    A file that is renamed during the read is read to its end. A line that a killed writer left unfinished is skipped.
    """
    file: BinaryIO = open(next(iter(_there(path)), path), "rb")  # noqa: SIM115 - closed below
    following: BinaryIO | None = None
    rest = b""
    try:
        while True:
            running = goes_on()  # asked first, so that no line written in between is missed
            following = _next(path, file)  # also asked first: a renamed file is complete
            while chunk := file.read(_CHUNK):
                *whole, rest = (rest + chunk).split(b"\n")
                yield from (line.decode(errors="replace") for line in whole)
            if following:
                file.close()
                file, following, rest = following, None, b""
            elif running:
                sleep_s(_LOOK_S)
            else:
                return
    finally:
        for each in (file, following):
            if each:
                each.close()


def _there(path: Path) -> list[Path]:
    """Returns the existing files of a log, the oldest first."""
    aside = [each for each in path.parent.glob(f"{path.name}.*") if each.suffix[1:].isdecimal()]
    aside.sort(key=lambda each: -int(each.suffix[1:]))
    return [*aside, path] if path.exists() else aside


def _next(path: Path, file: BinaryIO) -> BinaryIO | None:
    """Opens the file that follows this one; if this one was removed, the oldest that exists."""
    own = os.fstat(file.fileno())
    newer: BinaryIO | None = None
    for each in reversed(_there(path)):
        try:
            opened = open(each, "rb")  # noqa: SIM115 - returned open
        except FileNotFoundError:  # renamed at this moment
            if newer:
                newer.close()
            return _next(path, file)
        if os.path.samestat(os.fstat(opened.fileno()), own):
            opened.close()
            return newer
        if newer:
            newer.close()
        newer = opened
    return newer

"""Files of one log: it may be split into numbered parts, and each part may be compressed.

The parts are `log.lcm`, `log.lcm.01`, `log.lcm.02` and so on. Each is a log of its own; the numbers of its events
continue those of the part before, so a log of another program with such a name is not taken for a part. A part that is
missing between others is known by its number; reading continues behind it.
"""

import os
import re
import struct
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from fwk.lcm.log_file import LogError, LogFile, existing, is_compressed, opened
from fwk.lcm.seekable_zstd import SUFFIX

SYNC = (0xEDA1DA01).to_bytes(4, "big")
"""First bytes of each event."""
_NUMBER = struct.Struct(">4sq")  # sync word and number of an event
_LATER_PART = re.compile(r"(.+)\.(\d{2,5})")
_SEARCHED_BYTES = 1 << 20
"""Beginning of a part in which its first whole event is looked for."""


class MissingFiles(NamedTuple):
    """Files of a log that are missing between others."""

    files: list[Path]
    position: int
    """End of the part before, in bytes from the beginning of the log."""


class LogBytes:
    """The bytes of all parts of a log, one after another. What is appended later is not part of them.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """

    def __init__(self, path: Path) -> None:
        numbered = _numbered_parts(path)
        self._paths = list(map(uncompressed_name, numbered.values()))  # a part may be compressed while others are read
        self._open: tuple[int, LogFile] | None = None
        self._ends: list[int] = []
        self.missing: list[MissingFiles] = []
        self.mtime_ns = 0
        """Time at which the newest part was written, by its file system."""
        end = following = 0
        for place, number in enumerate(numbered):
            if number > following:
                files = [part_path(self._paths[0], each) for each in range(following, number)]
                self.missing.append(MissingFiles(files, end))
            following = number + 1
            part = self._part(place)
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

    def _part(self, place: int) -> LogFile:
        if self._open is None or self._open[0] != place:
            self.close()
            self._open = place, opened(self._paths[place])
        return self._open[1]


def parts_of(path: Path) -> list[Path]:
    """Returns the files of a log, of which each but the first continues another one.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """
    return list(_numbered_parts(path).values())


def _numbered_parts(path: Path) -> dict[int, Path]:
    """Returns the files of a log by number, in order; the first one has the number 0.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """
    first = existing(path)
    if first is None:
        opened(path)  # raises with the reason
    return {0: first or path, **_later_parts(uncompressed_name(path))}


def _later_parts(log: Path) -> dict[int, Path]:
    """Returns the files that continue a log, by number, in order."""
    try:
        names = os.listdir(log.parent)
    except OSError:
        return {}
    matched = [_LATER_PART.fullmatch(name.removesuffix(SUFFIX)) for name in names]
    highest = max((int(each[2]) for each in matched if each and each[1] == log.name), default=0)
    # each number is looked at: a list of names may lack a part that is compressed in this moment
    numbered = {number: existing(part_path(log, number)) for number in range(1, highest + 1)}
    return {number: part for number, part in numbered.items() if part and _continues(part)}


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


def exists(log: Path) -> bool:
    """Returns whether the first file of a log exists, compressed or not."""
    return existing(log) is not None


def remove_parts(log: Path) -> None:
    """Removes the parts of a log behind the first one, and a compressed first one.

    Raises:
        OSError: a file cannot be removed.
    """
    for part in _later_parts(log).values():
        part.unlink()
    log.with_name(log.name + SUFFIX).unlink(missing_ok=True)


def _continues(path: Path) -> bool:
    """Returns whether the first event in a file is not the first one of its log; so it is in a compressed part."""
    if is_compressed(path):
        return True
    try:
        file = opened(path)
    except LogError:
        return False
    try:
        head = file.read(0, _NUMBER.size)
        if not head.startswith(SYNC):  # perhaps damaged
            head = file.read(0, _SEARCHED_BYTES)
            head = head[head.find(SYNC) :] if SYNC in head else b""
    finally:
        file.close()
    return len(head) >= _NUMBER.size and _NUMBER.unpack_from(head)[1] > 0


def _head(path: Path) -> bytes:
    file = opened(path)
    try:
        return file.read(0, _NUMBER.size)
    finally:
        file.close()

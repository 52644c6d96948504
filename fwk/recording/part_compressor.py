"""Compresses the files of a log in place."""

import fcntl
import os
import queue
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from fwk.lcm.log_file import LogError, locked
from fwk.lcm.log_parts import is_log
from fwk.lcm.seekable_zstd import SUFFIX, CompressedFile, CompressedFileError, compress

_COMPARED_BYTES = 1 << 20
_LOWEST_PRIORITY = 19


def compress_part(part: Path) -> bool:
    """Puts a compressed file in the place of a file of a log, once it has been read back.

    Returns:
        whether it was compressed: not, if a run still writes it.

    Raises:
        LogError: the library is missing, the file is not a log, or it cannot be read, replaced or read back.
    """
    if not part.is_file() or (part.stat().st_size and not is_log(part)):  # never replaces a device or another file
        raise LogError(f"{part}: is not the file of an LCM log; it stays as it is")
    made = part.with_name(f".{part.name}{SUFFIX}.part")
    try:
        with open(part, "rb") as opened:
            if not locked(opened.fileno(), fcntl.LOCK_EX):
                return False
            compress(part, made)
            if not _is_equal(part, made):
                raise LogError(f"{part}: stays as it is: its compressed file could not be read back")
            os.replace(made, part.with_name(part.name + SUFFIX))
            part.unlink()
            return True
    except OSError as error:
        raise LogError(f"{part}: cannot be compressed: {error.strerror or error}") from error
    except CompressedFileError as error:
        raise LogError(f"{part}: cannot be compressed: {error}") from error
    finally:
        with suppress(OSError):
            made.unlink(missing_ok=True)


class PartCompressor:
    """Compresses files in a thread of the lowest priority, one after another."""

    def __init__(self, report: Callable[[str], None]) -> None:
        self._report = report
        self._parts: queue.SimpleQueue[Path | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="compressor", daemon=True)
        self._thread.start()

    def add(self, part: Path) -> None:
        """Adds a finished file."""
        self._parts.put(part)

    def close(self) -> None:
        """Waits until all files are compressed."""
        self._parts.put(None)
        self._thread.join()

    def _run(self) -> None:
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _LOWEST_PRIORITY)
        while part := self._parts.get():
            try:
                compress_part(part)
            except LogError as error:
                self._report(str(error))


def _is_equal(plain: Path, made: Path) -> bool:
    compressed = CompressedFile(made)
    try:
        with open(plain, "rb") as file:
            position = 0
            while data := file.read(_COMPARED_BYTES):
                if compressed.read(position, len(data)) != data:
                    return False
                position += len(data)
            return position == compressed.size_bytes
    finally:
        compressed.close()

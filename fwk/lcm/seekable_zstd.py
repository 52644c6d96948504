"""Compressed files that can be read at any position: frames of Zstandard, with a table of the frames at the end.

This is Zstandard's "seekable format", a file of which is also an ordinary one: `zstd -d` reads it.
"""

import os
import struct
from bisect import bisect_right
from itertools import accumulate
from pathlib import Path
from typing import Any

SUFFIX = ".zst"
INSTALL = "pip install 'fwk[compress]'"
FRAME_BYTES = 1 << 20
"""Uncompressed size of each frame but the last."""
_SKIPPABLE = struct.Struct("<II")  # mark of a frame that decoders skip, and the size of its content
_ENTRY = struct.Struct("<II")  # compressed and uncompressed size of a frame
_END = struct.Struct("<IBI")  # number of frames, flags, and the mark of the format
_SKIPPABLE_MARK, _FORMAT_MARK = 0x184D2A5E, 0x8F92EAB1
_CHECKED = 0x80  # flag: each entry of the table also has a check sum
_LEVEL = 3


class CompressedFileError(Exception):
    """A compressed file cannot be read or made; the text names the reason."""


def compress(source: Path, target: Path) -> None:
    """Compresses a file; the target, which is replaced if it exists, has the same times.

    Raises:
        OSError: a file cannot be read or written.
        CompressedFileError: the library is missing.
    """
    compressor = library().ZstdCompressor(level=_LEVEL, write_checksum=True, write_content_size=True)
    table = bytearray()
    with open(source, "rb") as plain, open(target, "wb") as made:
        while data := plain.read(FRAME_BYTES):
            frame = compressor.compress(data)
            made.write(frame)
            table += _ENTRY.pack(len(frame), len(data))
        end = _END.pack(len(table) // _ENTRY.size, 0, _FORMAT_MARK)
        made.write(_SKIPPABLE.pack(_SKIPPABLE_MARK, len(table) + len(end)) + table + end)
        found = os.fstat(plain.fileno())
    os.utime(target, ns=(found.st_atime_ns, found.st_mtime_ns))


class CompressedFile:
    """A compressed file whose uncompressed bytes can be read at any position; keeps one frame in memory.

    Raises:
        OSError: the file cannot be read.
        CompressedFileError: the file has no table of its frames, or the library is missing.
    """

    def __init__(self, path: Path) -> None:
        zstandard = library()
        self._error = zstandard.ZstdError
        self._decompressor = zstandard.ZstdDecompressor()
        self._descriptor = os.open(path, os.O_RDONLY)
        try:
            found = os.fstat(self._descriptor)
            sizes = self._table(found.st_size)
        except BaseException:
            self.close()
            raise
        self._begins = [0, *accumulate(compressed for compressed, _ in sizes)]
        self._ends = list(accumulate(plain for _, plain in sizes))
        self._frame: tuple[int, bytes] = -1, b""
        self.size_bytes = self._ends[-1] if self._ends else 0
        """Uncompressed size."""
        self.mtime_ns = found.st_mtime_ns
        """Time at which the uncompressed file was written."""

    def read(self, position: int, size: int) -> bytes:
        """Returns the uncompressed bytes from a position on, up to `size` of them.

        Raises:
            CompressedFileError: the file is damaged there.
        """
        found = bytearray()
        while len(found) < size and position < self.size_bytes:
            number = bisect_right(self._ends, position)
            begin = self._ends[number - 1] if number else 0
            data = self._frame_of(number)[position - begin : position - begin + size - len(found)]
            found += data
            position += len(data)
        return bytes(found)

    def close(self) -> None:
        """Closes the file."""
        os.close(self._descriptor)

    def _frame_of(self, number: int) -> bytes:
        if self._frame[0] != number:
            begin, end = self._begins[number], self._begins[number + 1]
            plain_bytes = self._ends[number] - (self._ends[number - 1] if number else 0)
            try:
                data = self._decompressor.decompress(os.pread(self._descriptor, end - begin, begin))
            except self._error:
                data = b""
            # a damaged frame reads as zeros, in which a reader of logs finds no event and goes on behind them
            self._frame = number, data if len(data) == plain_bytes else bytes(plain_bytes)
        return self._frame[1]

    def _table(self, file_bytes: int) -> list[tuple[int, int]]:
        """Returns compressed and uncompressed size of each frame."""
        end = os.pread(self._descriptor, _END.size, max(0, file_bytes - _END.size))
        frames, flags, mark = _END.unpack(end) if len(end) == _END.size else (0, 0, 0)
        entry_bytes = _ENTRY.size + (4 if flags & _CHECKED else 0)
        begin = file_bytes - _END.size - frames * entry_bytes
        if mark != _FORMAT_MARK or begin < _SKIPPABLE.size:
            raise CompressedFileError(
                "no table of its frames, as 'fwk compress' writes one; uncompress it with: zstd -d FILE"
            )
        table = os.pread(self._descriptor, frames * entry_bytes, begin)
        return [_ENTRY.unpack_from(table, place) for place in range(0, len(table), entry_bytes)]


def library() -> Any:
    """Returns the module that compresses.

    Raises:
        CompressedFileError: it is not installed.
    """
    try:
        import zstandard
    except ImportError as error:
        raise CompressedFileError(f"needs another library: {INSTALL}") from error
    return zstandard

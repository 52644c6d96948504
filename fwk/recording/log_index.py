"""Index of a log: a small file beside the log with its contents, so that a large log opens at once.

The index also holds check sums of the log, which tell damage from a difference.
"""

import json
import os
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple, Self

from fwk.lcm.log_file import LogError
from fwk.lcm.log_parts import LogBytes, uncompressed_name
from fwk.recording.log_contents import ChangedBytes, ChannelInfo, LogInfo, Note

VERSION = 1
BLOCK_BYTES = 1 << 20
"""Least size of a block with a check sum; a block ends with a whole event."""
_NOT_STORED = ("file", "damaged_bytes", "from_index", "changed", "missing")
_UNREADABLE = (OSError, ValueError, TypeError, LookupError, AttributeError)


class Block(NamedTuple):
    """Part of a log with a check sum, from the end of the block before it."""

    end: int
    """Position in the log behind the block, in bytes."""
    crc32: int
    tick: int
    """Newest tick whose record the log holds up to the end of the block; 0: none."""
    time_us: int
    """Latest time stamp up to the end of the block."""


@dataclass
class LogIndex:
    """Contents and check sums of a log."""

    info: LogInfo
    mtime_ns: int
    """Time at which the newest part of the log was written, by its file system."""
    blocks: list[Block]

    @classmethod
    def of(cls, log: Path) -> Self | None:
        """Reads the index of a log; None: there is none that can be read."""
        try:
            content = json.loads(index_path(log).read_bytes())
            if content.pop("version") != VERSION:
                return None
            mtime_ns, blocks = int(content.pop("mtime_ns")), [Block(*each) for each in content.pop("blocks")]
            notes = [Note(*each) for each in content.pop("notes")]
            channels = {name: _channel(each) for name, each in content.pop("channels").items()}
            info = LogInfo(log, **content, notes=notes, channels=channels, from_index=True)
            ends = [block.end for block in blocks]
            return cls(info, mtime_ns, blocks) if ends == sorted(ends) and ends[-1] == info.size_bytes else None
        except _UNREADABLE:
            return None

    def write(self) -> None:
        """Writes the index beside its log, completely or not at all; without room on the disk there is no index."""
        info = {name: value for name, value in asdict(self.info).items() if name not in _NOT_STORED}
        for channel in info["channels"].values():
            del channel["_highest"]
        content = {"version": VERSION, "mtime_ns": self.mtime_ns, **info, "blocks": self.blocks}
        path = index_path(self.info.file)
        part = path.with_name(f"{path.name}.part")
        try:
            part.write_text(json.dumps(content))
            os.replace(part, path)
        except OSError:
            part.unlink(missing_ok=True)

    def is_current(self) -> bool:
        """Returns whether the log is the one that was indexed: by size and time, or else by all check sums."""
        try:
            with LogBytes(self.info.file) as log:
                if log.size_bytes != self.info.size_bytes:
                    return False
                is_untouched = log.mtime_ns == self.mtime_ns
            return is_untouched or not any(self.changes())
        except (OSError, LogError):
            return False

    def changes(self) -> Iterator[ChangedBytes]:
        """Reads the log and yields the blocks whose bytes are not those that were written.

        Behind a missing part the bytes have no place, and are not compared.
        """
        begin, tick = 0, 0
        with LogBytes(self.info.file) as log:
            end = log.missing[0].position if log.missing else self.info.size_bytes
            for block in self.blocks:
                if block.end > end:
                    return
                data = log.read(begin, block.end - begin)
                missing = len(data) < block.end - begin
                if missing or zlib.crc32(data) != block.crc32:
                    first = begin + len(data) if missing else begin
                    yield ChangedBytes(first, block.end - 1, tick + 1, block.tick + 1, missing)
                begin, tick = block.end, block.tick


def index_path(log: Path) -> Path:
    """Returns the path of a log's index: `log.lcm.index`, also for a compressed log."""
    return log.with_name(f"{uncompressed_name(log).name}.index")


def changed(log: Path) -> list[ChangedBytes]:
    """Returns the parts of a log that are not what was written; empty without an index."""
    index = LogIndex.of(log)
    return list(index.changes()) if index else []


def _channel(content: dict[str, Any]) -> ChannelInfo:
    gaps = [(int(first), int(last)) for first, last in content.pop("gaps")]
    return ChannelInfo(**content, gaps=gaps)

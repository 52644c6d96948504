"""Decides when writing may be tried again after a disk was full."""

import os
from pathlib import Path

_ROOM_BYTES = 1 << 20  # more than a few free pages, so that writing does not fail again at once


def has_room(file: Path) -> bool:
    """Returns whether the disk of a file has room again."""
    try:
        disk = os.statvfs(file.parent)
    except OSError:
        return False
    return disk.f_bavail * disk.f_frsize >= _ROOM_BYTES

"""A full disk: when writing may be tried again."""

import os
from pathlib import Path

_ROOM_BYTES = 1 << 20  # so that one who found no room does not come back for every page that becomes free


def has_room(file: Path) -> bool:
    """Whether there is room again where a file lies."""
    try:
        disk = os.statvfs(file.parent)
    except OSError:
        return False
    return disk.f_bavail * disk.f_frsize >= _ROOM_BYTES

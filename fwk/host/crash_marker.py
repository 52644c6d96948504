"""Shared-memory marker of the component that each host executes, to attribute crashes."""

import mmap
import struct

from fwk.model.plan import NOBODY

_ENTRY = struct.Struct("=i")


class CrashMarker:
    """One component index for each host; processes forked afterwards write it, the supervisor reads it."""

    def __init__(self, hosts: int) -> None:
        self._memory = mmap.mmap(-1, max(1, hosts) * _ENTRY.size)
        for host in range(hosts):
            self.works(host, NOBODY)

    def works(self, host: int, component: int) -> None:
        """Notes that a component of the host is being executed; `NOBODY`: none is."""
        _ENTRY.pack_into(self._memory, host * _ENTRY.size, component)

    def at(self, host: int) -> int:
        """Returns the index of the component that is being executed, or was when the process ended."""
        index: int = _ENTRY.unpack_from(self._memory, host * _ENTRY.size)[0]
        return index

"""Which component of a shared process works at the moment, in memory that outlives the process: to find the guilty."""

import mmap
import struct

from fwk.model.plan import NOBODY

_ENTRY = struct.Struct("=i")


class Progress:
    """One number for each host; the processes forked after this was made write it, the supervisor reads it."""

    def __init__(self, hosts: int) -> None:
        self._memory = mmap.mmap(-1, max(1, hosts) * _ENTRY.size)
        for host in range(hosts):
            self.works(host, NOBODY)

    def works(self, host: int, component: int) -> None:
        """That component begins to work; `NOBODY`: the framework itself."""
        _ENTRY.pack_into(self._memory, host * _ENTRY.size, component)

    def at(self, host: int) -> int:
        """Index of the component that works, or worked when the process ended."""
        index: int = _ENTRY.unpack_from(self._memory, host * _ENTRY.size)[0]
        return index

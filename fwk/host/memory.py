"""How much memory a process may take beyond what it began with; what goes beyond that fails where it is asked for."""

import re
import resource
from pathlib import Path

_KIB = 1 << 10
MIB = 1 << 20


def limit_memory(mebibytes: float) -> None:
    """Limits private memory to what the process has now and so much more.

    What it shares with the process that it was forked from counts as had; shared memory does not count.
    """
    status = Path("/proc/self/status").read_text()
    found = re.search(r"^VmData:\s*(\d+) kB", status, re.M)
    had = int(found[1]) * _KIB if found else 0
    resource.setrlimit(resource.RLIMIT_DATA, (had + round(mebibytes * MIB), resource.RLIM_INFINITY))


def lift_limit() -> None:
    """No limit any more: telling what happened takes memory, too."""
    resource.setrlimit(resource.RLIMIT_DATA, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

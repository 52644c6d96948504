"""Limits the memory that a process may allocate; an allocation beyond the limit raises MemoryError."""

import re
import resource
from pathlib import Path

_KIB = 1 << 10
MIB = 1 << 20


def limit_memory(mebibytes: float) -> None:
    """Limits private memory to what the process has now plus `mebibytes`.

    Memory shared with the parent process counts as present; shared memory segments do not count.
    """
    status = Path("/proc/self/status").read_text()
    found = re.search(r"^VmData:\s*(\d+) kB", status, re.M)
    had = int(found[1]) * _KIB if found else 0
    resource.setrlimit(resource.RLIMIT_DATA, (had + round(mebibytes * MIB), resource.RLIM_INFINITY))


def lift_limit() -> None:
    """Removes the limit, because reporting a failure needs memory too."""
    resource.setrlimit(resource.RLIMIT_DATA, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

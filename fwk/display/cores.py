"""Cores and memory that this process may use."""

import math
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_GROUPS = Path("/proc/self/cgroup")
_MOUNT = Path("/sys/fs/cgroup")


def usable_cores(groups: Path = _GROUPS, mount: Path = _MOUNT) -> int:
    """Returns the cores that this process may run on, at most those that its control groups grant.

    A container has a limit in its control group: `docker run --cpus=2` on a machine of 16 cores.
    """
    count = len(os.sched_getaffinity(0))
    for folder in _folders("cpu", groups, mount):
        count = min(count, math.ceil(_granted(folder) or count))
    return count


def memory_limit_bytes(groups: Path = _GROUPS, mount: Path = _MOUNT) -> int | None:
    """Returns the memory that the control groups of this process grant, such as `docker run --memory=1g`; None: any."""
    limits = []
    for folder in _folders("memory", groups, mount):
        for name in ("memory.max", "memory.limit_in_bytes"):
            with suppress(OSError, ValueError):  # 'max': no limit
                limits.append(int((folder / name).read_text()))
    return min(limits, default=None)


def _folders(controller: str, groups: Path, mount: Path) -> Iterator[Path]:
    """Yields the folders of the control groups of this process, each before its parents, of both versions."""
    with suppress(OSError):
        for line in groups.read_text().splitlines():
            _, controllers, path = line.split(":", 2)
            if controllers and controller not in controllers.split(","):
                continue
            top = mount / controller if controllers else mount
            own = top / path.lstrip("/")
            yield from (folder for folder in (own, *own.parents) if folder.is_relative_to(top))


def _granted(folder: Path) -> float:
    """Returns the cores that a control group grants, of either version; 0: no limit."""
    with suppress(OSError, ValueError):
        quota, period = (folder / "cpu.max").read_text().split()
        return int(quota) / int(period)  # 'max': no limit
    with suppress(OSError, ValueError):
        quota, period = ((folder / f"cpu.cfs_{name}_us").read_text() for name in ("quota", "period"))
        return max(0, int(quota)) / int(period)
    return 0

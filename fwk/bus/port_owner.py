"""Finds the process that has a UDP port."""

import os
from pathlib import Path


def port_owner(port: int) -> str:
    """Returns the processes that have a UDP port, as text: ` (pid 12: nc)`; of other users' only the user is known."""
    inodes = _inodes(port)
    if not inodes:
        return ""
    named = [_named(pid) for pid in _pids({f"socket:[{inode}]" for inode in inodes})]
    return f" ({', '.join(named or [f'user {uid}' for uid in sorted(set(inodes.values()))])})"


def _inodes(port: int) -> dict[str, str]:
    """Returns inodes and users of the sockets that are bound to a port."""
    found = {}
    for line in Path("/proc/net/udp").read_text().splitlines()[1:]:
        words = line.split()
        if int(words[1].rpartition(":")[2], 16) == port:
            found[words[9]] = words[7]
    return found


def _pids(links: set[str]) -> list[int]:
    found = []
    for pid in sorted(int(name) for name in os.listdir("/proc") if name.isdigit()):
        try:
            if any(os.readlink(f"/proc/{pid}/fd/{name}") in links for name in os.listdir(f"/proc/{pid}/fd")):
                found.append(pid)
        except OSError:  # of another user, or ended
            continue
    return found


def _named(pid: int) -> str:
    try:
        return f"pid {pid}: {Path(f'/proc/{pid}/comm').read_text().strip()}"
    except OSError:
        return f"pid {pid}"

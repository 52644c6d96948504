"""UDP sockets of this machine and the processes that have them, as the kernel shows them."""

import os
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

_TABLE = Path("/proc/net/udp")


class UdpSocket(NamedTuple):
    """A UDP socket that is bound to a port."""

    inode: str
    user: str
    """Number of the user."""
    waiting: bool
    """Whether datagrams wait in it."""


def sockets_on(port: int) -> Iterator[UdpSocket]:
    """Yields the sockets of all users that are bound to a port; none where the kernel shows no table."""
    ending = f":{port:04X}"
    with suppress(OSError):
        for line in _TABLE.read_text().splitlines():
            if ending in line:
                columns = line.split()
                if columns[1].endswith(ending):
                    yield UdpSocket(columns[9], columns[7], not columns[4].endswith(":00000000"))


def owners(inodes: Iterable[str]) -> Iterator[tuple[str, int]]:
    """Yields each of these sockets with the process number of each of its owners, as far as this user may know them."""
    links = {f"socket:[{inode}]": inode for inode in inodes}
    for process in sorted(map(int, filter(str.isdigit, os.listdir("/proc") if links else ()))):
        for link in dict.fromkeys(_links(f"/proc/{process}/fd")):
            if link in links:
                yield links[link], process


def _links(folder: str) -> Iterator[str]:
    with suppress(OSError):  # of another user, or ended
        for name in os.listdir(folder):
            with suppress(OSError):  # closed
                yield os.readlink(f"{folder}/{name}")


def process_name(process: int) -> str:
    """Returns the name of a process as `ps` shows it; empty if it has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/comm").read_text().strip()
    return ""

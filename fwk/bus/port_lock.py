"""Lock that keeps two runs on a machine from using the same ports."""

import json
import os
import socket
import struct

from fwk.model.ports import Ports

_BLOCK = 64


class PortsInUseError(Exception):
    """Another run uses some of the ports; names that run and the ports to use instead."""

    def __init__(self, text: str, fact: str = "") -> None:
        super().__init__(text)
        self.fact = fact
        """The ports and the run that uses them, without the name of the refused run and the remedy."""


class PortLock:
    """Holds the ports of a run as long as the process lives; other processes can find that process."""

    def __init__(self, ports: Ports, name: str, public_url: str = "") -> None:
        self._sockets: list[socket.socket] = []
        first, last = ports.base // _BLOCK, (ports.end - 1) // _BLOCK
        free = (last + 1 + last - first) * _BLOCK
        for block in range(first, last + 1):
            used = f"ports {ports.base} to {ports.end - 1} are used"
            self._take(f"ports-{block}", name, used, f"start this one with --bus-port {free}")
        if public_url:
            bus = public_url.partition("?")[0]
            advice = f"start this one with --bus-port {free} or another public_url"
            self._take(f"public-{bus}", name, f"the public bus {bus} is used", advice)

    def _take(self, what: str, name: str, used: str, advice: str) -> None:
        lock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            lock.bind(_address(what))
            lock.listen()
        except OSError as error:
            lock.close()
            self.release()
            fact = f"{used} by another run{_holder(what)}"
            raise PortsInUseError(f"{name}: {fact}; stop it, or {advice}", fact) from error
        self._sockets.append(lock)

    def belong_to_this_process(self) -> None:
        """Names this process as the holder, after a fork."""
        for lock in self._sockets:
            lock.listen()

    def release(self) -> None:
        """Releases the ports."""
        for lock in self._sockets:
            lock.close()
        self._sockets = []


def _address(what: str) -> str:
    return f"\0fwk-{what}"


def _holder(what: str) -> str:
    """Returns the process that holds a lock, as text; empty if it is unknown."""
    probe = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        probe.setblocking(False)
        probe.connect(_address(what))
        credentials = probe.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
        pid = struct.unpack("3i", credentials)[0]
        with open(f"/proc/{pid}/cmdline", "rb") as file:
            words = file.read().decode(errors="replace").split("\0")
        return f" (pid {pid}: {json.dumps(' '.join(map(os.path.basename, words)).strip())})" if pid else ""
    except OSError:
        return ""
    finally:
        probe.close()

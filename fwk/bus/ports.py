"""Which UDP port carries what in a run, and the lock that keeps two runs off the same ports."""

import json
import os
import socket
import struct
from dataclasses import dataclass

from fwk.plan.model import Plan

STAGES_MAX = 30
_BLOCK = 64


@dataclass(frozen=True)
class Ports:
    """All ports of a run, counted from its bus port.

    A host sends from its own port; so does the gateway, which is the host after the last.
    """

    base: int
    hosts: int
    channels: int

    @classmethod
    def of(cls, plan: Plan) -> "Ports":
        """The ports of a plan."""
        return cls(plan.bus_port, len(plan.hosts), len(plan.channels) + plan.spare_channels)

    @property
    def sync(self) -> int:
        """Dones and states, to the supervisor."""
        return self.base

    def stage(self, index: int) -> int:
        """Ticks of a stage."""
        return self.base + 1 + index

    @property
    def record(self) -> int:
        """Tick records, to recorder and gateway."""
        return self.base + 1 + STAGES_MAX

    @property
    def log(self) -> int:
        """Lines of text."""
        return self.record + 1

    @property
    def status(self) -> int:
        """The supervisor's view of the run."""
        return self.record + 2

    @property
    def supervisor(self) -> int:
        """The port that the supervisor sends from."""
        return self.record + 3

    def host(self, index: int) -> int:
        """The port that a host sends from and can be asked at."""
        return self.supervisor + 1 + index

    @property
    def gateway(self) -> int:
        """The gateway's host index."""
        return self.hosts

    @property
    def members(self) -> range:
        """All ports that processes of the run send from."""
        return range(self.supervisor, self.host(self.gateway) + 1)

    def channel(self, index: int) -> int:
        """Messages of a channel."""
        return self.host(self.hosts + 1) + index

    @property
    def end(self) -> int:
        """The first port that the run does not use."""
        return self.channel(self.channels)


class PortsInUse(Exception):  # noqa: N818 - it says what is
    """Another run has some of the ports; says which run and how to get around."""


class PortLock:
    """Holds the ports of a run as long as the process lives, and tells others who holds them."""

    def __init__(self, ports: Ports, name: str, public_url: str = "") -> None:
        self._sockets: list[socket.socket] = []
        first, last = ports.base // _BLOCK, (ports.end - 1) // _BLOCK
        free = (last + 1 + last - first) * _BLOCK
        for block in range(first, last + 1):
            used = f"ports {ports.base} to {ports.end - 1} are used"
            self._take(f"ports-{block}", f"{name}: {used}", f"start this one with --bus-port {free}")
        if public_url:
            bus = public_url.partition("?")[0]
            advice = f"start this one with --bus-port {free} or another public_url"
            self._take(f"public-{bus}", f"{name}: the public bus {bus} is used", advice)

    def _take(self, what: str, used: str, advice: str) -> None:
        lock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            lock.bind(_address(what))
            lock.listen()
        except OSError as error:
            lock.close()
            self.release()
            raise PortsInUse(f"{used} by another run{_holder(what)}; stop it, or {advice}") from error
        self._sockets.append(lock)

    def release(self) -> None:
        """Gives the ports back."""
        for lock in self._sockets:
            lock.close()
        self._sockets = []


def _address(what: str) -> str:
    return f"\0fwk-{what}"


def _holder(what: str) -> str:
    """Who holds a lock, as the kernel knows it; empty if it cannot be told."""
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

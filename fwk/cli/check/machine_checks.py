"""Checks of the machine: each tries one thing that runs need, and names a command that helps."""

import errno
import mmap
import os
import resource
import select
import shutil
import socket
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.bus.sockets import BUFFER_BYTES, GROUP, LOOPBACK
from fwk.lcm.typegen import lcm_gen
from fwk.model.ports import Ports

_WAIT_S = 1.0
_PORTS_END = 65536
_FILES = 1024  # a supervisor of a hundred processes, or a gateway to a few hundred channels


class Severity(StrEnum):
    """Severity of a finding."""

    OK = "ok"
    WARNING = "warning"
    """Runs work, but something beside them does not."""
    BAD = "bad"
    """Runs do not work."""


@dataclass(frozen=True)
class Finding:
    """The result of one check."""

    level: Severity
    subject: str
    text: str
    advice: str = ""
    """Command that helps."""


def multicast_route() -> Finding:
    """Checks the public bus, for which LCM leaves the choice of the interface to the routing table."""
    advice = "sudo ip link set lo up multicast on; sudo ip route add 224.0.0.0/4 dev lo"
    return _multicast("multicast by route (public bus)", None, advice)


def multicast_loopback() -> Finding:
    """Checks the inner buses."""
    return _multicast("multicast on lo (inner buses)", LOOPBACK, "sudo ip link set lo up multicast on")


def receive_buffers() -> Finding:
    """Checks that sockets get buffers large enough for bursts of messages."""
    subject = "receive buffers"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        size = probe.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) // 2  # the kernel reports twice the size
    if size >= BUFFER_BYTES:
        return Finding(Severity.OK, subject, f"{size} bytes")
    advice = f"sudo sysctl -w net.core.rmem_max={BUFFER_BYTES}; for good: the same line in /etc/sysctl.d/60-lcm.conf"
    return Finding(Severity.WARNING, subject, f"{size} bytes, wanted {BUFFER_BYTES}: bursts lose messages", advice)


def ports(wanted: Ports) -> Finding:
    """Checks that the ports of a run are free."""
    subject = f"ports {wanted.base} to {wanted.end - 1}"
    if wanted.end > _PORTS_END:
        advice = f"fwk-launch FILE --bus-port {_PORTS_END - wanted.end + wanted.base}"
        return Finding(Severity.BAD, subject, f"the highest port is {_PORTS_END - 1}", advice)
    try:
        PortLock(wanted, "the next run").release()
    except PortsInUseError as error:
        return Finding(Severity.WARNING, subject, str(error))
    taken = [port for port in range(wanted.base, wanted.end) if not _is_free(port)]
    if taken:
        advice = f"fwk-launch FILE --bus-port {wanted.end + 1000}"
        return Finding(Severity.WARNING, subject, f"other programs use {', '.join(map(str, taken[:5]))}", advice)
    return Finding(Severity.OK, subject, "free")


def java() -> Finding:
    """Checks the programs that `fwk spy` needs."""
    missing = [program for program in ("java", "javac") if not shutil.which(program)]
    if missing:
        text = f"no {', '.join(missing)}: 'fwk spy' does not work"
        return Finding(Severity.WARNING, "Java", text, "sudo apt install default-jdk")
    return Finding(Severity.OK, "Java", "installed, for 'fwk spy'")


def shared_memory() -> Finding:
    """Checks that processes can share camera frames."""
    subject = "shared memory (memfd)"
    try:
        descriptor = os.memfd_create("fwk-doctor")
        try:
            os.ftruncate(descriptor, mmap.PAGESIZE)
            with mmap.mmap(descriptor, mmap.PAGESIZE) as memory, open(f"/proc/self/fd/{descriptor}", "rb") as other:
                memory[:4] = b"seen"
                works = other.read(4) == b"seen"
        finally:
            os.close(descriptor)
    except OSError as error:
        return Finding(Severity.BAD, subject, f"{error.strerror}: cameras do not work")
    return Finding(
        Severity.OK if works else Severity.BAD, subject, "works" if works else "a second mapping reads other bytes"
    )


def generator() -> Finding:
    """Checks that message types can be generated."""
    subject, advice = "lcm-gen", "pip install --force-reinstall lcm; sudo apt install libglib2.0-0"
    try:
        result = subprocess.run([lcm_gen(), "--version"], capture_output=True, text=True, check=False)
    except OSError as error:
        return Finding(Severity.BAD, subject, f"{lcm_gen()}: {error.strerror}", advice)
    if result.returncode:
        return Finding(Severity.BAD, subject, f"{lcm_gen()}: {result.stderr.strip()}", advice)
    return Finding(Severity.OK, subject, result.stdout.strip())


def open_files() -> Finding:
    """Checks the number of files and sockets that a process may open."""
    limit, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if limit == resource.RLIM_INFINITY or limit >= _FILES:
        return Finding(Severity.OK, "open files", f"{limit} a process")
    advice = f"ulimit -n {_FILES if hard == resource.RLIM_INFINITY else min(_FILES, hard)}"
    return Finding(Severity.WARNING, "open files", f"{limit} a process: large launch files need {_FILES}", advice)


def all_checks(wanted: Ports) -> list[Callable[[], Finding]]:
    """Returns all checks, the most important first; `wanted` are the ports of a run."""
    return [
        multicast_loopback,
        multicast_route,
        receive_buffers,
        lambda: ports(wanted),
        shared_memory,
        generator,
        open_files,
        java,
    ]


def _multicast(subject: str, interface: str | None, advice: str) -> Finding:
    """Sends a datagram to LCM's group within this machine, and waits for it."""
    address = socket.inet_aton(interface or "0.0.0.0")
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as hears,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sends,
    ):
        try:
            hears.bind((GROUP, 0))
            hears.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + address)
            sends.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            sends.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, address)
            sends.sendto(b"fwk doctor", (GROUP, hears.getsockname()[1]))
        except OSError as error:
            return Finding(Severity.BAD, subject, str(error.strerror), advice)
        if not select.select([hears], [], [], _WAIT_S)[0]:
            return Finding(
                Severity.BAD,
                subject,
                "a datagram that was sent did not arrive; is there a firewall?",
                "sudo nft list ruleset",
            )
    return Finding(Severity.OK, subject, "datagrams arrive")


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((LOOPBACK, port))
        except OSError as error:
            return error.errno == errno.EADDRNOTAVAIL  # there is no loopback; another check says so
    return True

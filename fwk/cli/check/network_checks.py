"""Checks of multicast, socket buffers, ports and the public bus."""

import errno
import select
import socket

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.bus.port_owner import port_owner
from fwk.bus.public import PublicBus
from fwk.bus.sockets import BUFFER_BYTES, GROUP, LOOPBACK
from fwk.cli.check.findings import Finding, Severity
from fwk.launcher.machine import THROUGH_FIREWALL, loopback_mistake, taken_ports
from fwk.model.ports import Ports
from fwk.model.public_url import parse_url

_WAIT_S = 1.0
_PORTS_END = 65536
_APART = 64
_NAMED = 5


def multicast_loopback() -> Finding:
    """Checks the inner buses, which use the interface lo."""
    subject = "multicast on lo (inner buses)"
    if mistake := loopback_mistake():
        reason, command = mistake
        return Finding(Severity.BAD, subject, f"{reason}: the processes of a run cannot talk", command)
    return _datagram(subject, LOOPBACK, Severity.BAD)


def multicast_route() -> Finding:
    """Checks the public bus, for which LCM leaves the choice of the interface to the routing table."""
    return _datagram("multicast by route (public bus)", "0.0.0.0", Severity.WARNING)


def receive_buffers() -> Finding:
    """Checks that sockets get buffers large enough for bursts of messages."""
    subject = "receive buffers"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        size = probe.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) // 2  # the kernel reports twice the size
    if size >= BUFFER_BYTES:
        return Finding(Severity.OK, subject, f"{size} bytes")
    setting = f"net.core.rmem_max={BUFFER_BYTES}"
    advice = f"sudo sysctl -w {setting}; for good: echo {setting} | sudo tee /etc/sysctl.d/60-lcm.conf"
    return Finding(Severity.WARNING, subject, f"{size} bytes, wanted {BUFFER_BYTES}: bursts lose messages", advice)


def ports(wanted: Ports) -> Finding:
    """Checks that the ports of a run are free."""
    subject = f"ports {wanted.base} to {wanted.end - 1}"
    if wanted.end > _PORTS_END:
        advice = f"fwk-launch FILE --bus-port {_PORTS_END - wanted.end + wanted.base}"
        return Finding(Severity.BAD, subject, f"the highest port is {_PORTS_END - 1}", advice)
    if text := _users(wanted):
        return Finding(Severity.WARNING, subject, text, _on_free_ports(wanted))
    return Finding(Severity.OK, subject, "free")


def public_bus(url: str, wanted: Ports) -> Finding:
    """Checks that a run with these ports can open its public bus."""
    subject = "public bus"
    if not url:
        return Finding(Severity.OK, subject, "the launch file has none")
    port = parse_url(url)[1]
    try:
        PublicBus(url).close()
    except OSError as error:
        if error.errno != errno.EADDRINUSE:
            return Finding(Severity.BAD, subject, f"{url} cannot be opened: {error.strerror}")
        text = f"another program has UDP port {port} for itself{port_owner(port)}"
        advice = f"{_on_free_ports(wanted)}; or another public_url in the launch file"
        return Finding(Severity.BAD, subject, text, advice)
    return Finding(Severity.OK, subject, f"port {port} can be shared")


def _users(wanted: Ports) -> str:
    """Returns what uses ports of a run, as text; empty if all are free."""
    try:
        PortLock(wanted, "").release()
    except PortsInUseError as error:
        return error.fact.removeprefix(f"ports {wanted.base} to {wanted.end - 1} are ")
    taken = taken_ports(wanted)
    named = ", ".join(f"{port}{port_owner(port)}" for port in taken[:_NAMED])
    return f"other programs use {named}{', ...' if len(taken) > _NAMED else ''}" if taken else ""


def _on_free_ports(wanted: Ports) -> str:
    """Returns the command that starts a run on the next free ports."""
    size = wanted.end - wanted.base
    bases = range(wanted.end + -wanted.end % _APART, _PORTS_END - size, _APART)
    free = (base for base in bases if not _users(Ports(base, wanted.hosts, wanted.channels)))
    return f"fwk-launch FILE --bus-port {next(free, wanted.base)}"


def _datagram(subject: str, address: str, level: Severity) -> Finding:
    """Sends a datagram to LCM's group within this machine, and waits for it."""
    interface = socket.inet_aton(address)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as hears,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sends,
    ):
        try:
            hears.bind((GROUP, 0))
            hears.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + interface)
            sends.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            sends.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, interface)
            sends.sendto(b"fwk doctor", (GROUP, hears.getsockname()[1]))
        except PermissionError:
            return Finding(level, subject, f"a firewall forbids datagrams to {GROUP}", THROUGH_FIREWALL)
        except OSError as error:
            text = f"no route to {GROUP} ({error.strerror}): lcm-spy and other programs of LCM hear nothing"
            advice = "sudo ip link set lo up multicast on; sudo ip route replace 224.0.0.0/4 dev lo"
            return Finding(level, subject, text, advice)
        if not select.select([hears], [], [], _WAIT_S)[0]:
            text = f"a datagram to {GROUP} does not arrive: a firewall drops it"
            return Finding(level, subject, text, THROUGH_FIREWALL)
    return Finding(Severity.OK, subject, "datagrams arrive")

"""Requirements of a run on the machine, checked before its start: network, ports, names, files, cores, memory."""

import errno
import fcntl
import resource
import socket
import struct
from pathlib import Path

from fwk.bus.port_owner import port_owner
from fwk.bus.public import PublicBus
from fwk.bus.sockets import GROUP, LOOPBACK, multicast_holder, own_socket
from fwk.control.address import gateway_address, supervisor_address
from fwk.display.cores import memory_limit_bytes, usable_cores
from fwk.display.plan_overview import fewer_processes
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.model.public_url import parse_url

THROUGH_FIREWALL = f"sudo iptables -I INPUT -d {GROUP} -j ACCEPT; sudo iptables -I OUTPUT -d {GROUP} -j ACCEPT"
"""Command that lets datagrams to LCM's group pass."""
_SIOCGIFFLAGS, _IFF_UP = 0x8913, 1
_PORTS_NAMED = 3
_FILES_BESIDE = 64
_FILES_A_HOST = 4
_HOSTS_A_CORE = 8
_HOST_BYTES = 12 << 20
_LIBRARIES_BYTES = 150 << 20


class MachineError(Exception):
    """The machine lacks something that the run needs; the text names it, and the remedy."""


def check_machine(plan: Plan) -> None:
    """Checks that a run can start.

    Raises:
        MachineError: it cannot.
    """
    _check_files(plan)
    _check_loopback()
    check_ports(plan)
    _check_names(plan)
    if plan.public_url:
        try:
            PublicBus(plan.public_url).close()
        except OSError as error:
            owner = port_owner(parse_url(plan.public_url)[1]) if error.errno == errno.EADDRINUSE else ""
            raise MachineError(
                f"the public bus {plan.public_url} cannot be opened: {error.strerror}{owner}; 'fwk doctor' says what "
                "to type, or write 'public_url: \"\"' into the launch file"
            ) from error


def check_ports(plan: Plan) -> None:
    """Checks that no other program has a port of the run.

    Raises:
        MachineError: a program has some.
    """
    if used := taken_ports(Ports.of(plan)):
        more = ", ..." if len(used) > _PORTS_NAMED else ""
        raise MachineError(
            f"{plan.name}: another program uses UDP port {', '.join(map(str, used[:_PORTS_NAMED]))}{more}"
            f"{port_owner(used[0])}; end it, "
            f"or start this run with another --bus-port"
        )


def taken_ports(ports: Ports) -> list[int]:
    """Returns the ports of a run that other programs have."""
    return [port for port in range(ports.base, ports.end) if not _is_free(port, port in ports.members)]


def advice(plan: Plan, cores: int | None = None, free_bytes: int | None = None) -> list[str]:
    """Returns a line for each resource of which the machine has too little for real time; the run still starts."""
    cores = cores or usable_cores()
    free_bytes = free_bytes or _free_bytes()
    hosts = len(plan.hosts)
    remedy = fewer_processes(plan)
    lines = []
    if hosts > _HOSTS_A_CORE * cores:
        core_word = "core" if cores == 1 else "cores"
        lines.append(
            f"{hosts} processes share {cores} {core_word}: if the run is slower than real time, start it with {remedy}"
        )
    needed = _LIBRARIES_BYTES + hosts * _HOST_BYTES
    if free_bytes and needed > free_bytes:
        lines.append(
            f"{hosts} processes need some {needed >> 20} MB of memory, and {free_bytes >> 20} MB are free: "
            f"start the run with {remedy}"
        )
    return lines


def _check_files(plan: Plan) -> None:
    _, limit = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = _FILES_BESIDE + _FILES_A_HOST * len(plan.hosts) + len(plan.channels)
    if limit != resource.RLIM_INFINITY and limit < needed:
        raise MachineError(
            f"{plan.name}: the run needs about {needed} open files in a process, {limit} are allowed; "
            f"allow more with: ulimit -n {max(1024, needed)}"
        )


def _check_loopback() -> None:
    if mistake := loopback_mistake():
        raise MachineError(f"no IPv4 multicast on the interface lo: {mistake[0]}; type: {mistake[1]}")


def loopback_mistake() -> tuple[str, str] | None:
    """Returns why the interface lo has no IPv4 multicast, and the command that helps; None: lo has multicast."""
    advice = "sudo ip link set lo up multicast on"
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            if _is_up("lo", probe):
                advice = f"sudo ip address add {LOOPBACK}/8 dev lo"
                probe.bind((LOOPBACK, 0))
                advice = "sudo ip link set lo multicast on; sudo ip route add 224.0.0.0/4 dev lo"
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            membership = socket.inet_aton(GROUP) + socket.inet_aton(LOOPBACK)
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            probe.bind((LOOPBACK, 0))
            probe.sendto(b"", (GROUP, probe.getsockname()[1]))
    except PermissionError:
        return "a firewall forbids datagrams", THROUGH_FIREWALL
    except OSError as error:
        return str(error.strerror), advice
    return None


def _is_up(interface: str, any_socket: socket.socket) -> bool:
    request = struct.pack("16sh14x", interface.encode(), 0)
    try:
        (flags,) = struct.unpack_from("h", fcntl.ioctl(any_socket, _SIOCGIFFLAGS, request), 16)
    except OSError:
        return False
    return bool(flags & _IFF_UP)


def _check_names(plan: Plan) -> None:
    for address in (supervisor_address(plan.bus_port), gateway_address(plan.bus_port)):
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
            try:
                probe.bind(address)
            except OSError as error:
                name = address.lstrip("\0")
                raise MachineError(
                    f"{plan.name}: another process has the control socket @{name}; end it, or start this run with "
                    "another --bus-port"
                ) from error


def _is_free(port: int, own: bool) -> bool:
    """Returns whether a port can be bound: one that a process sends from (`own`), or one of the group."""
    try:
        (own_socket if own else multicast_holder)(port).close()
    except OSError as error:
        return error.errno != errno.EADDRINUSE
    return True


def _free_bytes() -> int:
    """Returns the memory that programs can get, in bytes; 0: unknown."""
    try:
        rows = dict(line.split(":", 1) for line in Path("/proc/meminfo").read_text().splitlines())
        free_bytes = int(rows["MemAvailable"].split()[0]) << 10
        return min(free_bytes, memory_limit_bytes() or free_bytes)
    except (OSError, KeyError, ValueError):
        return 0

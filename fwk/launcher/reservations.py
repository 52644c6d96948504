"""Ports and names that a run holds from before its first process starts until it has ended."""

import socket
from collections.abc import Mapping

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.bus.port_owner import port_owner
from fwk.bus.sockets import multicast_holder, own_socket
from fwk.control.address import gateway_address, supervisor_address
from fwk.control.server import ControlNameError, listen
from fwk.model.plan import Plan
from fwk.model.ports import Ports


class Reservations:
    """Every port and both control sockets of a run, opened at once, so that no other program can take one later.

    The forked processes inherit them; each closes those that are not its own.

    Raises:
        PortsInUseError: another run or another program has a port.
        ControlNameError: another process has a control socket's name.
    """

    def __init__(self, plan: Plan, lock: PortLock) -> None:
        self._ports = ports = Ports.of(plan)
        self._who = plan.file or plan.name
        self._opened: list[socket.socket] = []
        self._lock = lock
        try:
            self.own = {port: self._open(port) for port in ports.members}
            """Sockets that the supervisor, the hosts and the gateway send from, by port."""
            for port in sorted({*range(ports.base, ports.end)} - {*ports.members}):
                self._open(port)
            self.supervisor = self._listen(supervisor_address(plan.bus_port))
            """Control socket of the supervisor."""
            self.gateway = self._listen(gateway_address(plan.bus_port))
            """Control socket of the gateway."""
        except (PortsInUseError, ControlNameError):
            self.release()
            raise

    @property
    def hosts(self) -> Mapping[int, socket.socket]:
        """The hosts' own sockets, by port."""
        return {self._ports.host(host): self.own[self._ports.host(host)] for host in range(self._ports.hosts)}

    @property
    def not_for_hosts(self) -> list[socket.socket]:
        """All sockets but those of the hosts."""
        hosts = set(self.hosts.values())
        return [each for each in self._opened if each not in hosts]

    def keep_for_gateway(self) -> Mapping[int, socket.socket]:
        """Closes the supervisor's sockets in the gateway's process; returns the gateway's own socket."""
        self.supervisor.close()
        port = self._ports.host(self._ports.gateway)
        return {port: self.own[port]}

    def release(self) -> None:
        """Releases all ports and names, as far as this process is concerned."""
        for each in self._opened:
            each.close()
        self._lock.release()

    def _open(self, port: int) -> socket.socket:
        try:
            made = own_socket(port) if port in self._ports.members else multicast_holder(port)
        except OSError as error:
            raise PortsInUseError(
                f"{self._who}: UDP port {port} cannot be opened: {error.strerror}{port_owner(port)}; end that program, "
                "or start this run with another --bus-port"
            ) from error
        self._opened.append(made)
        return made

    def _listen(self, address: str) -> socket.socket:
        self._opened.append(listen(address))
        return self._opened[-1]

"""The network of a simulated world, at the level of datagrams: receivers, delays and losses."""

from __future__ import annotations

import errno
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from fwk.bus.sockets import GROUP, LOOPBACK, Address

if TYPE_CHECKING:
    from tests.simulation.process import Process
    from tests.simulation.world import World

SEND_US = 3
"""Wall time that sending a datagram takes."""
_FIRST_DESCRIPTOR = 10_000


class Source(ABC):
    """Something that a process can wait for."""

    def __init__(self, ether: Ether) -> None:
        self.watcher: Process | None = None
        self._descriptor = ether.register(self)

    def fileno(self) -> int:
        """Returns the descriptor."""
        return self._descriptor

    @property
    @abstractmethod
    def readable(self) -> bool:
        """Returns whether there is something to read."""


class Signal(Source):
    """Becomes readable when `set` is called, and stays so until `clear` is called."""

    def __init__(self, ether: Ether) -> None:
        super().__init__(ether)
        self._set = False

    @property
    def readable(self) -> bool:
        """Returns whether it is set."""
        return self._set

    def set(self) -> None:
        """Makes it readable."""
        self._set = True
        if self.watcher:
            self.watcher.arrived()

    def clear(self) -> None:
        """Makes it unreadable."""
        self._set = False

    def recv(self, _size: int, /) -> bytes:
        """Returns nothing once it is set, like a closed connection.

        Raises:
            BlockingIOError: it is not set.
        """
        if not self._set:
            raise BlockingIOError
        return b""


class SimulatedSocket(Source):
    """A non-blocking UDP socket of a simulated process."""

    def __init__(self, process: Process, ether: Ether, port: int, group: bool) -> None:
        super().__init__(ether)
        self.process = process
        self.port = port
        self.closed = False
        self._ether = ether
        self._group = group
        self._waiting: deque[tuple[bytes, Address]] = deque()

    @property
    def readable(self) -> bool:
        """Returns whether a datagram waits."""
        return bool(self._waiting)

    def fileno(self) -> int:
        """Returns the descriptor; -1 once the socket is closed."""
        return -1 if self.closed else super().fileno()

    def recvfrom(self, _size: int, /) -> tuple[bytes, Address]:
        """Returns the next datagram and the address of its sender.

        Raises:
            BlockingIOError: no datagram waits.
        """
        if not self._waiting:
            if self.closed:
                raise OSError(errno.EBADF, "closed")
            raise BlockingIOError
        self.process.received()
        return self._waiting.popleft()

    def sendto(self, data: bytes, address: Address, /) -> int:
        """Sends a datagram."""
        if self.process.may_send():
            self._ether.send(self.process, (LOOPBACK, self.port), address, data)
        return len(data)

    def close(self) -> None:
        """Releases the socket."""
        if not self.closed:
            self._ether.forget(self, self._group)
            self.closed = True
            self.watcher = None

    def deliver(self, data: bytes, address: Address) -> None:
        """Delivers a datagram."""
        if not self.closed:
            self._waiting.append((data, address))
            if self.watcher:
                self.watcher.arrived()


class Ether:
    """Connects all sockets of a world. Datagrams from one socket to another keep their order unless one is delayed."""

    def __init__(self, world: World) -> None:
        self.lost = 0
        self.sources: dict[int, Source] = {}
        self.on_sent: Callable[[Address, bytes], None] = _nothing
        """Called with every datagram that is sent."""
        self._world = world
        self._groups: dict[int, list[SimulatedSocket]] = {}
        self._own: dict[int, SimulatedSocket] = {}
        self._arrivals: dict[tuple[int, int], int] = {}  # port of the sender, descriptor: time of the newest arrival

    def register(self, source: Source) -> int:
        """Returns a descriptor for something that can be waited for."""
        descriptor = _FIRST_DESCRIPTOR + len(self.sources)
        self.sources[descriptor] = source
        return descriptor

    def open(self, process: Process, port: int, group: bool) -> SimulatedSocket:
        """Opens a socket.

        Raises:
            OSError: another socket has the port.
        """
        made = SimulatedSocket(process, self, port, group)
        if group:
            self._groups.setdefault(port, []).append(made)
        elif port in self._own:
            raise OSError(errno.EADDRINUSE, f"port {port} is in use")
        else:
            self._own[port] = made
        return made

    def forget(self, socket: SimulatedSocket, group: bool) -> None:
        """Closes a socket."""
        if group:
            self._groups[socket.port].remove(socket)
        else:
            del self._own[socket.port]

    def send(self, process: Process, source: Address, address: Address, data: bytes) -> None:
        """Sends a datagram to every socket that receives from the address, to each with a separate delay."""
        to, port = address
        world = self._world
        world.trace.add(process.local_us, process.name, f"-> {_place(address)}", data)
        self.on_sent(address, data)
        if process.reached_port and address != (GROUP, process.reached_port):
            self.lost += 1
            return
        if to == GROUP:
            for hearer in self._groups.get(port, ()):
                self._carry(process, source, hearer, data)
        elif port in self._own:
            self._carry(process, source, self._own[port], data)

    def _carry(self, process: Process, source: Address, hearer: SimulatedSocket, data: bytes) -> None:
        world = self._world
        weather, random = world.weather, world.random
        times = 1
        if weather.loss and random.random() < weather.loss:
            self.lost += 1
            world.trace.add(process.local_us, process.name, f"lost on the way to {hearer.process.name}:", data)
            return
        if weather.duplicate and random.random() < weather.duplicate:
            times = 2
        for _ in range(times):
            departure = process.local_us
            arrival = departure + 1 + int(random.random() * weather.latency_us)
            if weather.delay and random.random() < weather.delay:
                arrival += random.randint(0, weather.delay_us)  # others may overtake it
            else:
                way = (source[1], hearer.fileno())
                arrival = max(arrival, self._arrivals.get(way, 0) + 1)
                self._arrivals[way] = arrival
            world.at(arrival, partial(self._arrive, process, departure, hearer, data, source))

    def _arrive(
        self, process: Process, departure_us: int, hearer: SimulatedSocket, data: bytes, source: Address
    ) -> None:
        if process.died_us is None or departure_us <= process.died_us:
            hearer.deliver(data, source)


def _nothing(_address: Address, _data: bytes) -> None:
    pass


def _place(address: Address) -> str:
    return f"port {address[1]}" if address[0] == GROUP else f"port {address[1]} alone"

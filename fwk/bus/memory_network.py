"""A network without a machine for one participant: its driver fills the sockets and takes what is sent."""

from collections import deque
from collections.abc import Callable
from typing import TypeVar

from fwk.bus.network import Steps
from fwk.bus.sockets import GROUP, LOOPBACK, Address
from fwk.bus.waiting import Source

T = TypeVar("T")

_FIRST_DESCRIPTOR = 3

Sent = Callable[[bytes, Address], None]
"""Takes a datagram and the address that it was sent to."""


class MemorySocket:
    """A socket whose datagrams wait in a queue."""

    def __init__(self, descriptor: int, port: int, sent: Sent, closed: Callable[["MemorySocket"], None]) -> None:
        self.port = port
        self.queue: deque[tuple[bytes, Address]] = deque()
        """Datagrams that have arrived, each with the address of its sender."""
        self._descriptor = descriptor
        self._sent = sent
        self._closed = closed

    def recvfrom(self, _size: int, /) -> tuple[bytes, Address]:
        """Returns the next datagram and the address that it came from.

        Raises:
            BlockingIOError: no datagram waits.
        """
        if not self.queue:
            raise BlockingIOError
        return self.queue.popleft()

    def sendto(self, data: bytes, address: Address, /) -> int:
        """Passes a datagram to the driver."""
        self._sent(data, address)
        return len(data)

    def fileno(self) -> int:
        """Returns the number that names this socket; -1 once it is closed."""
        return self._descriptor

    def close(self) -> None:
        """Closes the socket."""
        if self._descriptor >= 0:
            self._closed(self)
            self._descriptor = -1


class MemoryNetwork:
    """Sockets and wall clock of one participant, driven from outside.

    Args:
        sent: takes every datagram that the participant sends.
        opened: called for every socket that the participant opens.
    """

    def __init__(self, sent: Sent, opened: Callable[[MemorySocket], None] = lambda _: None) -> None:
        self.clock_us = 0
        """The participant's wall time; only the driver moves it."""
        self._sent = sent
        self._opened = opened
        self._sockets: dict[int, MemorySocket] = {}
        self._by_port: dict[tuple[str, int], MemorySocket] = {}
        self._watched: dict[int, MemorySocket] = {}
        self._descriptors = _FIRST_DESCRIPTOR

    def now_us(self) -> int:
        """Returns the wall time in microseconds."""
        return self.clock_us

    def group_socket(self, port: int) -> MemorySocket:
        """Opens a socket that receives from the multicast group on `port`."""
        return self._open(GROUP, port)

    def own_socket(self, port: int) -> MemorySocket:
        """Opens the socket that sends from `port` and receives what is sent to `port` alone."""
        return self._open(LOOPBACK, port)

    def watch(self, source: Source) -> None:
        """Lets `source` end waits from now on."""
        descriptor = source if isinstance(source, int) else source.fileno()
        self._watched[descriptor] = self._sockets[descriptor]

    def unwatch(self, source: Source) -> None:
        """Takes `source` out of the waits."""
        del self._watched[source if isinstance(source, int) else source.fileno()]

    def put(self, datagram: bytes, address: Address, port: int) -> bool:
        """Puts a datagram from port `port` of the run into the socket at `address`; returns whether there is one."""
        socket = self._by_port.get(address)
        if socket is not None:
            socket.queue.append((datagram, (LOOPBACK, port)))
        return socket is not None

    def drop(self, address: Address, unwanted: Callable[[bytes], bool]) -> None:
        """Drops the unwanted ones of the datagrams that wait in the socket at `address`."""
        socket = self._by_port.get(address)
        if socket is not None:
            socket.queue = deque(each for each in socket.queue if not unwanted(each[0]))

    def run(self, steps: Steps[T], until_us: int) -> int:
        """Resumes a participant that waits until `until_us`, as long as datagrams for it are there.

        Returns:
            The wall time until which it waits then.

        Raises:
            StopIteration: the participant has ended; the exception carries its result.
        """
        while readable := [descriptor for descriptor, socket in self._watched.items() if socket.queue]:
            until_us = steps.send(readable)
        return until_us

    def run_once(self, steps: Steps[T], until_us: int) -> int:
        """Advances the time to the end of a participant's wait, and resumes the participant.

        Returns:
            The wall time until which it waits then.

        Raises:
            StopIteration: the participant has ended; the exception carries its result.
        """
        self.clock_us = max(self.clock_us, until_us)
        return steps.send([])

    def _open(self, host: str, port: int) -> MemorySocket:
        made = MemorySocket(self._descriptors, port, self._sent, self._close)
        self._descriptors += 1
        self._sockets[made.fileno()] = self._by_port[host, port] = made
        self._opened(made)
        return made

    def _close(self, socket: MemorySocket) -> None:
        del self._sockets[socket.fileno()]
        self._watched.pop(socket.fileno(), None)
        for address in [address for address, each in self._by_port.items() if each is socket]:
            del self._by_port[address]

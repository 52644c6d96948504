"""The seam between a participant of a run and the machine: sockets, waiting and the wall clock.

Supervisor, host and gateway are *participants*: generators that yield the wall time until which they wait and are
resumed with the descriptors that became readable, or with none at that time. A participant opens every socket through
its `Network` and knows no other source of time, so the same code runs on UDP sockets, in a simulated world and on a
recording.
"""

import os
import socket
from collections.abc import Generator, Mapping
from typing import Protocol, TypeVar

from fwk.bus.sockets import Address, multicast_receiver, own_socket
from fwk.bus.waiting import Source, Waiting
from fwk.clock import monotonic_us

T = TypeVar("T")

_PIPE_BYTES = 1 << 16

Steps = Generator[int, list[int], T]
"""A participant at work: yields a wall time in microseconds, receives the descriptors that are readable then."""


class DatagramSocket(Protocol):
    """A non-blocking UDP socket."""

    def recvfrom(self, size: int, /) -> tuple[bytes, Address]:
        """Returns the next datagram and the address that it came from.

        Raises:
            BlockingIOError: no datagram waits.
        """
        ...

    def sendto(self, data: bytes, address: Address, /) -> int:
        """Sends a datagram."""
        ...

    def fileno(self) -> int:
        """Returns the descriptor that names this socket in `watch` and among the readable ones."""
        ...

    def close(self) -> None:
        """Releases the socket."""
        ...


class Network(Protocol):
    """Sockets, waiting and wall clock of one process."""

    def now_us(self) -> int:
        """Returns the wall time in microseconds, from an arbitrary origin."""
        ...

    def group_socket(self, port: int) -> DatagramSocket:
        """Opens a socket that receives from the multicast group on `port`, like others on this machine."""
        ...

    def own_socket(self, port: int) -> DatagramSocket:
        """Opens the socket that sends from `port` and receives what is sent to `port` alone."""
        ...

    def watch(self, source: Source) -> None:
        """Lets `source` end waits from now on."""
        ...

    def unwatch(self, source: Source) -> None:
        """Takes `source` out of the waits."""
        ...


class UdpNetwork:
    """The network of a real process: UDP on the loopback interface and epoll.

    `held` are sockets that were opened before this process was forked, by port: no other process can take these ports.
    """

    def __init__(self, held: Mapping[int, socket.socket] | None = None) -> None:
        self._waiting = Waiting()
        self._held = held or {}
        self._wakeup = -1

    now_us = staticmethod(monotonic_us)

    def group_socket(self, port: int) -> DatagramSocket:
        """Opens a socket that receives from the multicast group on `port`."""
        return multicast_receiver(port)

    def own_socket(self, port: int) -> DatagramSocket:
        """Opens the socket that sends from `port` and receives what is sent to `port` alone, or shares a held one."""
        held = self._held.get(port)
        return own_socket(port) if held is None else held.dup()

    def watch(self, source: Source) -> None:
        """Lets `source` end waits from now on."""
        self._waiting.add(source)

    def unwatch(self, source: Source) -> None:
        """Takes `source` out of the waits."""
        self._waiting.remove(source)

    def watch_wakeup(self, descriptor: int) -> None:
        """Lets signals end waits, each signal one: Python writes to the other end of this pipe at every signal."""
        self._wakeup = descriptor
        self.watch(descriptor)

    def run(self, steps: Steps[T]) -> T:
        """Runs a participant to its end and returns its result."""
        wait = self._waiting.wait
        try:
            until_us = next(steps)
            while True:
                ready = wait(until_us - monotonic_us())
                if self._wakeup in ready:  # while it is readable, it would end every further wait at once
                    os.read(self._wakeup, _PIPE_BYTES)
                until_us = steps.send(ready)
        except StopIteration as end:
            result: T = end.value
            return result

    def close(self) -> None:
        """Releases the descriptor for waiting."""
        self._waiting.close()

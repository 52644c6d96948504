"""Protocols of the gateway's partners: sinks, the supervisor, programs outside the run."""

from typing import Protocol


class Sink(Protocol):
    """Takes all messages that the gateway collects."""

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Takes a message of a component, a tick record, a line of text or a status."""

    def tick(self) -> None:
        """Notes that all messages of a tick were passed on."""

    def close(self) -> None:
        """Writes the remaining data: the run is over."""


class SupervisorConnection(Protocol):
    """The connection that the supervisor closes when the run is over."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when the connection is closed."""
        ...

    def recv(self, size: int, /) -> bytes:
        """Returns what the supervisor sent; empty when the connection is closed.

        Raises:
            BlockingIOError: nothing waits.
        """
        ...

    def send(self, packet: bytes, /) -> int:
        """Sends a packet to the supervisor.

        Raises:
            OSError: the supervisor has died, or takes no packets.
        """
        ...


class Outsiders(Protocol):
    """Programs outside, on the public bus."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when a message waits."""
        ...

    def receive(self) -> tuple[str, bytes, int] | None:
        """Returns the next message as (channel, data, port of its sender); None when none waits."""
        ...

    def send(self, datagram: bytes) -> None:
        """Sends one datagram to them."""
        ...

    def busy_listeners(self) -> list[str] | None:
        """Returns the names of the programs that still work on earlier messages; None: no program listens."""
        ...

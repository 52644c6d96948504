"""What the gateway is connected to: sinks, the supervisor, programs outside the run."""

from typing import Protocol


class Sink(Protocol):
    """Takes everything that the gateway sees."""

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """A message of a component, of the main loop, a line of text or a status."""

    def tick(self) -> None:
        """A tick is complete."""

    def close(self) -> None:
        """The run is over."""


class SupervisorConnection(Protocol):
    """The connection that the supervisor closes when the run is over."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when the connection is closed."""
        ...

    def recv(self, size: int, /) -> bytes:
        """Returns what the supervisor sent; nothing when the connection is closed.

        Raises:
            BlockingIOError: nothing waits.
        """
        ...


class Outsiders(Protocol):
    """The programs outside, on the public bus."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when a message waits."""
        ...

    def receive(self) -> tuple[str, bytes, int] | None:
        """Returns the next message as (channel, data, port of its sender); None when none waits."""
        ...

    def send(self, datagram: bytes) -> None:
        """Sends one datagram to them."""
        ...

"""Receives messages in place of a process of a run."""

from fwk.bus.receiver import Complain, Receiver
from fwk.bus.sender import Sender
from fwk.model.ports import Ports


def _refuse(_channel: str, text: str) -> None:
    raise AssertionError(text)


def received(end: Sender, ports: Ports, complain: Complain = _refuse) -> tuple[bytes, bytes] | None:
    """Returns the next message of the run that was sent to `end` as (channel, data); None if none waits."""
    message = Receiver(end.socket, ports.members, "of this run", "fwk/fetch", complain).receive()
    return message[:2] if message else None

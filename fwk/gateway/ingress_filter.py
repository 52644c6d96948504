"""Other programs on the public bus: what they write on channels that the plan opens to them becomes part of the run."""

from collections.abc import Callable, Mapping
from typing import Any

from fwk.gateway.ingress import Full
from fwk.lcm import messages
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan

BYTES_MAX = 1 << 20
"""Of a message from outside: 64 may wait for a tick, and the gateway keeps them for readers that lose them."""


class IngressFilter:
    """Checks what others publish; `take_in` makes a message one of the run, `complain` says what is not taken."""

    def __init__(self, plan: Plan, take_in: Callable[[str, Any], int], complain: Callable[[str, str], None]) -> None:
        self._types: Mapping[str, Any] = {name: messages.type_named(kind) for name, kind in plan.outside.items()}
        self._names = {channel.name for channel in plan.channels}
        self._take_in = take_in
        self._complain = complain

    def hear(self, channel: str, data: bytes, port: int) -> None:
        """Somebody with this source port has published something."""
        kind = self._types.get(channel)
        if kind is None:
            if channel in self._names or channel.startswith("fwk/"):
                self._complain(channel, f"somebody else (port {port}) writes it on the public bus; not taken")
            return
        try:
            self._take_in(channel, checked(kind, data, channel))
        except (MessageError, Full) as error:
            reason = str(error).removeprefix(f"{channel}: ")
            self._complain(channel, f"from port {port} on the public bus: {reason}; not taken")


def checked(kind: type[messages.Message], data: bytes, channel: str) -> Any:
    """The message that these bytes are, and nothing besides.

    Raises:
        MessageError: they are no message of that type, or too many.
    """
    if len(data) > BYTES_MAX:
        raise MessageError(f"{channel}: {len(data)} bytes; from outside come at most {BYTES_MAX}")
    message = messages.decode(kind, data, channel)
    surplus = len(data) - len(message.encode())
    if surplus < 0:
        raise MessageError(f"{channel}: a text in this {messages.type_name(kind)} is no UTF-8")
    if surplus:
        raise MessageError(f"{channel}: {surplus} bytes more than a {messages.type_name(kind)} has")
    return message

"""Messages from outside the run: checked, stamped, sent to their readers, and reported until they are visible."""

from collections.abc import Callable
from typing import Any

from fwk.bus.sender import Sender
from fwk.clock import Clock
from fwk.engine.message_history import MessageHistory
from fwk.host.inputs import Inputs
from fwk.lcm import envelope, messages
from fwk.lcm.messages import Message, MessageError
from fwk.model.names import LINES
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from lcmtypes.core import header_t, tick_record_t

WRITER = "outside"
"""Writer in the headers of messages from outside."""
WAITING_MAX = 64
"""Messages of a channel that may wait for the next tick."""
BYTES_MAX = 1 << 20
"""Size of a message from outside: 64 may wait for a tick, and the gateway keeps them for readers that lose them."""


class IngressFullError(Exception):
    """Too many messages came in before a tick; the text names the channel."""


class Ingress:
    """The gateway as the writer of channels that programs outside and tools write.

    Args:
        plan: the plan of the run.
        sender: sends the messages to their readers.
        inputs: the gateway's own buffers, which also get them.
        clock: the newest tick.
        complain: takes the channel and the reason of each message that is refused.
    """

    def __init__(
        self, plan: Plan, sender: Sender, inputs: Inputs, clock: Clock, complain: Callable[[str, str], None]
    ) -> None:
        written = [each for each in plan.channels if each.of_tools or each.name in plan.outside or each.name == LINES]
        self._channels = {channel.name: channel for channel in written}
        self._stamp = {
            channel.index: envelope.stamper(messages.type_named(channel.type_name), channel.name) for channel in written
        }
        self._open_types = {name: messages.type_named(type_name) for name, type_name in plan.outside.items()}
        self._names = {channel.name for channel in plan.channels}
        self._histories = {channel.index: MessageHistory() for channel in written}
        self._sequences = {channel.index: 0 for channel in written}
        self._visible = {channel.index: 0 for channel in written}
        self._ports = Ports.of(plan)
        self._sender = sender
        self._inputs = inputs
        self._clock = clock
        self._complain = complain

    def hear(self, channel: str, data: bytes, port: int) -> None:
        """Takes or refuses a message that another program published from `port` of the public bus."""
        message_type = self._open_types.get(channel)
        if message_type is None:
            if channel in self._names or channel.startswith("fwk/"):
                self._complain(channel, f"another program (port {port}) writes it on the public bus; refused")
            return
        try:
            self.take_in(channel, checked(message_type, data, channel))
        except (MessageError, IngressFullError) as error:
            reason = str(error).removeprefix(f"{channel}: ")
            self._complain(channel, f"from port {port} on the public bus: {reason}; refused")

    def take_in(self, name: str, message: Any) -> int:
        """Stamps a message and sends it to its readers; returns its sequence number.

        Raises:
            IngressFullError: the main loop has not taken the last ones yet.
            MessageError: a field holds a value that its type cannot.
        """
        index = self._channels[name].index
        if self._sequences[index] - self._visible[index] >= WAITING_MAX:
            raise IngressFullError(f"{name}: {WAITING_MAX} messages wait for the next tick already")
        sequence, tick = self._sequences[index] + 1, self._clock.tick + 1
        data = self._stamp[index](message, tick, sequence, self._clock.now_us, header_t.OUTSIDE, WRITER)
        self._sequences[index] = sequence
        self._histories[index].add(tick, sequence, data)
        self._inputs.buffer(index).put(sequence, data)
        self._sender.publish(name.encode(), data, self._ports.channel(index))
        return sequence

    @property
    def marks(self) -> dict[int, int]:
        """Newest number of each channel with messages that no tick record has named yet, by index of the channel."""
        return {index: number for index, number in self._sequences.items() if number > self._visible[index]}

    def recorded(self, record: tick_record_t) -> None:
        """Notes the marks of a tick record: the supervisor knows these messages."""
        for index, sequence in zip(record.channel, record.sequence, strict=True):
            if index in self._visible:
                self._visible[index] = sequence

    def kept(self, channel: int, first: int, last: int) -> list[tuple[int, bytes]] | None:
        """Returns the messages `first` to `last` that are kept; None if the channel is not written here."""
        history = self._histories.get(channel)
        return None if history is None else history.between(first, last)


def checked(message_type: type[Message], data: bytes, channel: str) -> Any:
    """Returns the message of this type that exactly these bytes encode.

    Raises:
        MessageError: the bytes are not such a message, or too many.
    """
    if len(data) > BYTES_MAX:
        raise MessageError(f"{channel}: {len(data)} bytes; a message from outside has at most {BYTES_MAX}")
    message = messages.decode(message_type, data, channel)
    surplus = len(data) - len(message.encode())
    if surplus < 0:
        raise MessageError(f"{channel}: a text in this {messages.type_name(message_type)} is not UTF-8")
    if surplus:
        raise MessageError(f"{channel}: {surplus} bytes more than a {messages.type_name(message_type)} has")
    return message

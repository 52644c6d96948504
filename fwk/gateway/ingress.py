"""What comes into a run from outside: stamped here, sent on, and told to the main loop until it is visible."""

from typing import Any

from fwk.bus.sender import Sender
from fwk.clock import Clock
from fwk.engine.message_history import MessageHistory
from fwk.host.inputs import Inputs
from fwk.lcm import envelope, messages
from fwk.model.plan import ChannelPlan
from fwk.model.ports import Ports
from lcmtypes.core import header_t, tick_record_t

STAGE = header_t.OUTSIDE
"""In the header of what came from outside: it is visible from the beginning of a tick on."""
WRITER = "outside"
WAITING_MAX = 64


class Full(Exception):  # noqa: N818 - a state, not a mistake
    """Too much came in at once; says on which channel."""


class Outside:
    """The gateway as the writer of channels that no component writes."""

    def __init__(self, channels: list[ChannelPlan], ports: Ports, sender: Sender, inputs: Inputs, clock: Clock) -> None:
        self._channels = {channel.name: channel for channel in channels}
        self._stamp = {
            channel.index: envelope.stamper(messages.type_named(channel.type_name), channel.name)
            for channel in channels
        }
        self._histories = {channel.index: MessageHistory() for channel in channels}
        self._sequences = {channel.index: 0 for channel in channels}
        self._visible = {channel.index: 0 for channel in channels}
        self._ports = ports
        self._sender = sender
        self._inputs = inputs
        self._clock = clock

    def take_in(self, name: str, message: Any) -> int:
        """Stamps a message and sends it to its readers; returns its sequence number.

        Raises:
            Full: the main loop has not taken over the last ones yet.
            MessageError: a field holds something that its type cannot.
        """
        channel = self._channels[name]
        index = channel.index
        if self._sequences[index] - self._visible[index] >= WAITING_MAX:
            raise Full(f"{name}: {WAITING_MAX} messages wait for the next tick already")
        sequence, tick = self._sequences[index] + 1, self._clock.tick + 1
        data = self._stamp[index](message, tick, sequence, self._clock.now_us, STAGE, WRITER)
        self._sequences[index] = sequence
        self._histories[index].add(tick, sequence, data)
        self._inputs.buffer(index).put(sequence, data)
        self._sender.publish(name.encode(), data, self._ports.channel(index))
        return sequence

    @property
    def marks(self) -> dict[int, int]:
        """What the main loop has to be told: channels with messages that no record has named yet."""
        return {index: number for index, number in self._sequences.items() if number > self._visible[index]}

    def recorded(self, record: tick_record_t) -> None:
        """A tick is over; what its marks name needs no telling any more."""
        for index, sequence in zip(record.channel, record.sequence, strict=True):
            if index in self._visible:
                self._visible[index] = sequence

    def kept(self, channel: int, first: int, last: int) -> list[tuple[int, bytes]] | None:
        """Messages for a reader that lacks them; None if the channel is not written here."""
        history = self._histories.get(channel)
        return None if history is None else history.between(first, last)

"""Messages from outside the run: checked, stamped, and published on the inner bus in the name of nobody's component."""

from typing import Any

from fwk import messages
from fwk.aspects.blackboard import Stamp, Writes
from fwk.bus.ports import Ports
from fwk.bus.sockets import Sender
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.messages import MessageError
from fwk.plan.model import OUTSIDE_STAGE, Plan
from lcmtypes.core import fetch_t

WRITER = "outside"
"""Who has written a foreign message, as its header says."""
MOST_A_TICK = 100
"""Of each channel; who sends more is cut short, so that a flood costs the run no more than this."""


class Foreign:
    """The writer of all channels that programs outside may write.

    What is offered during a tick goes out together when the tick has been recorded; from the next boundary on it is
    visible. Readers that lose it fetch it here.
    """

    def __init__(self, plan: Plan, ports: Ports, sender: Sender, inputs: Inputs) -> None:
        self._stamp = Stamp(WRITER)
        self._stamp.stage = OUTSIDE_STAGE
        channels = {channel.name: channel for channel in plan.channels if channel.name in plan.outside}
        self._indices = {channel.index for channel in channels.values()}
        self._types = {name: messages.type_named(channel.type_name) for name, channel in channels.items()}
        self._writers: dict[str, Writes[Any]] = {
            name: Writes(name, kind, self._stamp) for name, kind in self._types.items()
        }
        boxes = {name: inputs.box(channel.index) for name, channel in channels.items()}
        self._outputs = Outputs(channels, ports, sender, boxes, {})
        self._offered: list[tuple[str, Any]] = []
        self.marks: dict[int, int] = {}
        """Channel index to the newest sequence number that went out."""

    def __contains__(self, channel: str) -> bool:
        return channel in self._types

    def offer(self, channel: str, data: bytes) -> None:
        """Takes a message of one of the channels.

        Raises:
            MessageError: it is none of the channel's type, or the channel has had enough for this tick.
        """
        message = messages.decode(self._types[channel], data, channel)
        if sum(name == channel for name, _ in self._offered) >= MOST_A_TICK:
            raise MessageError(f"more than {MOST_A_TICK} messages in a tick")
        self._offered.append((channel, message))

    def publish(self, tick: int, time_us: int) -> None:
        """Stamps and sends what was offered since the last time."""
        if not self._offered:
            return
        self._stamp.tick, self._stamp.time_us = tick, time_us
        offered, self._offered = self._offered, []
        for channel, message in offered:
            self._writers[channel].value = message
            self._writers[channel].write()
        written = [(channel, data) for channel, writer in self._writers.items() for data in writer.take()]
        self.marks.update(self._outputs.publish(written))

    def answers(self, fetch: fetch_t) -> bool:
        """Sends again what a reader lost; false if the channel has another writer."""
        if fetch.channel not in self._indices:
            return False
        self._outputs.answer(fetch)
        return True

"""The channels that a host writes: sends messages and answers fetches."""

from collections.abc import Callable, Mapping

from fwk.bus.sender import Sender
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.message_history import MessageHistory, gaps
from fwk.lcm.messages import tick_and_sequence_of
from fwk.model.plan import ChannelPlan
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t

LARGE_BYTES = 64 << 10
SHARED_US = 20_000
"""Time within which one repetition of a large message serves all readers that fetch it."""


class Outputs:
    """Sends the messages of a host's components, and keeps them for readers that lose some."""

    def __init__(
        self,
        written: Mapping[str, ChannelPlan],
        ports: Ports,
        sender: Sender,
        local: Mapping[str, ChannelBuffer],
        sequences: Mapping[str, int],
        now_us: Callable[[], int],
    ) -> None:
        self._written = {
            name: (plan.index, name.encode(), ports.channel(plan.index), MessageHistory())
            for name, plan in written.items()
        }
        # Messages of earlier incarnations, by channel.
        self._before = {plan.index: sequences.get(name, 0) for name, plan in written.items()}
        self._by_index = {index: (name, port, history) for index, name, port, history in self._written.values()}
        self._repeated: dict[tuple[int, int], int] = {}  # channel, number: time until which it is not sent again
        self._sender = sender
        self._now_us = now_us
        self._ports = ports
        self._local = local

    @property
    def sent(self) -> dict[int, int]:
        """Returns the newest sequence number that this host has sent of each channel, by index."""
        return {index: history.newest for index, (_, _, history) in self._by_index.items() if history.newest}

    def publish(self, written: list[tuple[str, bytes]]) -> dict[int, int]:
        """Sends messages; returns the new mark of each channel, by index."""
        marks = {}
        for channel, data in written:
            index, name, port, history = self._written[channel]
            tick, sequence = tick_and_sequence_of(data)
            history.add(tick, sequence, data)
            buffer = self._local.get(channel)
            if buffer is not None:
                buffer.put(sequence, data)
            self._sender.publish(name, data, port)
            marks[index] = sequence
        return marks

    def open(self, index: int, channel: str) -> None:
        """Begins to write a dynamic channel."""
        if index not in self._by_index:
            self._by_index[index] = (channel.encode(), self._ports.channel(index), MessageHistory())
        self._written[channel] = (index, *self._by_index[index])

    def answer(self, fetch: fetch_t) -> None:
        """Sends fetched messages again, or answers that they are no longer kept.

        A fetch of messages that an earlier incarnation sent goes on to the gateway, which may still have them.
        """
        if fetch.channel not in self._before:
            self._answer_dynamic(fetch)
            return
        before = self._before[fetch.channel]
        if fetch.first_sequence <= before:
            self._forward(fetch, fetch.first_sequence, min(fetch.last_sequence, before))
            fetch.first_sequence = before + 1
        _, _, history = self._by_index[fetch.channel]
        kept = history.between(fetch.first_sequence, fetch.last_sequence)
        for sequence, data in kept:
            self._repeat(fetch.channel, sequence, data)
        oldest = kept[0][0] if kept else fetch.last_sequence + 1
        if oldest > fetch.first_sequence:
            gone = gone_t()
            gone.run, gone.channel = fetch.run, fetch.channel
            gone.first_sequence, gone.last_sequence = fetch.first_sequence, oldest - 1
            self._sender.send(b"fwk/gone", gone.encode(), self._ports.host(fetch.host))

    def _answer_dynamic(self, fetch: fetch_t) -> None:
        """Answers a fetch of a dynamic channel with the messages of this host; the gateway may have the rest.

        Other hosts may also have written the channel, and so may an earlier incarnation of this one.
        """
        own = self._by_index.get(fetch.channel)
        kept = own[2].between(fetch.first_sequence, fetch.last_sequence) if own else []
        for sequence, data in kept:
            self._repeat(fetch.channel, sequence, data)
        for first, last in gaps((sequence for sequence, _ in kept), fetch.first_sequence, fetch.last_sequence):
            self._forward(fetch, first, last)

    def _repeat(self, channel: int, sequence: int, data: bytes) -> None:
        """Sends a message again; a large one once for all readers that fetch it at the same time."""
        name, port, _ = self._by_index[channel]
        now_us, this = self._now_us(), (channel, sequence)
        if now_us < self._repeated.get(this, 0):
            return
        self._sender.publish_paced(name, data, port)
        if len(data) > LARGE_BYTES:
            self._repeated = {each: until_us for each, until_us in self._repeated.items() if until_us > now_us}
            self._repeated[this] = max(now_us, self._sender.paced_until_us) + SHARED_US

    def _forward(self, fetch: fetch_t, first_sequence: int, last_sequence: int) -> None:
        forwarded = fetch_t()
        forwarded.run, forwarded.host, forwarded.channel = fetch.run, fetch.host, fetch.channel
        forwarded.first_sequence, forwarded.last_sequence = first_sequence, last_sequence
        self._sender.send(b"fwk/fetch", forwarded.encode(), self._ports.host(self._ports.gateway))

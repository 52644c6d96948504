"""What a host sends: its components' messages, and again those that readers lost."""

from collections.abc import Callable, Mapping

from fwk.bus.sender import Sender
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.message_history import History, gaps
from fwk.lcm.messages import tick_and_sequence_of
from fwk.model.plan import ChannelPlan
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t

LARGE_BYTES = 64 << 10
SHARED_US = 20_000


class Outputs:
    """The channels that a host's components write."""

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
            name: (plan.index, name.encode(), ports.channel(plan.index), History()) for name, plan in written.items()
        }
        self._before = {plan.index: sequences.get(name, 0) for name, plan in written.items()}  # sent by predecessors
        self._by_index = {index: (name, port, history) for index, name, port, history in self._written.values()}
        self._repeated: dict[tuple[int, int], int] = {}  # channel, number: until when it is not sent again
        self._sender = sender
        self._now_us = now_us
        self._ports = ports
        self._local = local

    @property
    def sent(self) -> dict[int, int]:
        """The newest number of each channel index that this process has sent."""
        return {index: history.newest for index, (_, _, history) in self._by_index.items() if history.newest}

    def publish(self, written: list[tuple[str, bytes]]) -> dict[int, int]:
        """Sends messages; returns the new mark of each channel index."""
        marks = {}
        for channel, data in written:
            index, name, port, history = self._written[channel]
            tick, sequence = tick_and_sequence_of(data)
            history.add(tick, sequence, data)
            box = self._local.get(channel)
            if box is not None:
                box.put(sequence, data)
            self._sender.publish(name, data, port)
            marks[index] = sequence
        return marks

    def open(self, index: int, channel: str) -> None:
        """From now on this process writes a channel that was opened at run time."""
        if index not in self._by_index:
            self._by_index[index] = (channel.encode(), self._ports.channel(index), History())
        self._written[channel] = (index, *self._by_index[index])

    def answer(self, fetch: fetch_t) -> None:
        """Sends again what a reader lacks, or tells it that this is no longer to be had.

        What a predecessor had sent, before this process was started in its place, the gateway may still have.
        """
        if fetch.channel not in self._before:
            self._answer_opened(fetch)
            return
        before = self._before[fetch.channel]
        if fetch.first_sequence <= before:
            self._pass_on(fetch, fetch.first_sequence, min(fetch.last_sequence, before))
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

    def _answer_opened(self, fetch: fetch_t) -> None:
        """Of a channel that was opened at run time: here is what this process wrote, the gateway may have the rest.

        Others may have written between, also a predecessor that this process has not opened it again after.
        """
        own = self._by_index.get(fetch.channel)
        kept = own[2].between(fetch.first_sequence, fetch.last_sequence) if own else []
        for sequence, data in kept:
            self._repeat(fetch.channel, sequence, data)
        for first, last in gaps((sequence for sequence, _ in kept), fetch.first_sequence, fetch.last_sequence):
            self._pass_on(fetch, first, last)

    def _repeat(self, channel: int, sequence: int, data: bytes) -> None:
        """Sends a message again; a large one slowly, and once for all who ask at the same time."""
        name, port, _ = self._by_index[channel]
        now_us, this = self._now_us(), (channel, sequence)
        if now_us < self._repeated.get(this, 0):
            return
        self._sender.publish_paced(name, data, port)
        if len(data) > LARGE_BYTES:
            self._repeated = {each: until_us for each, until_us in self._repeated.items() if until_us > now_us}
            self._repeated[this] = max(now_us, self._sender.paced_until_us) + SHARED_US

    def _pass_on(self, fetch: fetch_t, first_sequence: int, last_sequence: int) -> None:
        passed = fetch_t()
        passed.run, passed.host, passed.channel = fetch.run, fetch.host, fetch.channel
        passed.first_sequence, passed.last_sequence = first_sequence, last_sequence
        self._sender.send(b"fwk/fetch", passed.encode(), self._ports.host(self._ports.gateway))

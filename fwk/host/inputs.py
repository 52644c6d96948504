"""The channels that a host reads: collects the messages up to the marks and fetches lost ones."""

from collections.abc import Callable, Container, Sequence

from fwk.bus.channel_socket import ChannelSocket, Complain
from fwk.bus.network import Network, Steps
from fwk.bus.retransmission import Backoff
from fwk.bus.sender import Sender
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t, void_t

FIRST_WAIT_US = 200
"""Wait before the first fetch: on one machine a message arrives before the tick that names it, unless it was lost."""
SECOND_WAIT_US = 2_000
LONGEST_WAIT_US = 100_000
REAL_TIME_LONGEST_WAIT_US = 20_000
"""In real time fetches are repeated more often, because a writer has a limited time for its answer."""
WRITER_TIMEOUT_US = 500_000
"""In real time: a writer that has not answered by then may have stopped, and the gateway is asked instead."""


class Inputs:
    """The channels that a host reads, from other hosts or from itself (`local`).

    A later incarnation (`restarted`) may have to fetch messages of its own channels, too: those of its predecessor.
    """

    def __init__(
        self,
        plan: Plan,
        read: Sequence[ChannelPlan],
        local: Sequence[ChannelPlan],
        host: int,
        run: int,
        network: Network,
        sender: Sender,
        complain: Complain,
        restarted: bool = False,
    ) -> None:
        ports = Ports.of(plan)
        self._network = network
        self._sender = sender
        self._ports = ports
        real_time = plan.clock == "wall"
        self._writer_timeout_us = WRITER_TIMEOUT_US if real_time else 0
        self._longest_wait_us = REAL_TIME_LONGEST_WAIT_US if real_time else LONGEST_WAIT_US
        self._host = host
        self._run = run
        self._plan = plan
        self._complain = complain
        self._writer_host = {channel.index: self._host_of(channel.writer) for channel in read}
        own = {channel.name for channel in local}
        self._buffers: dict[int, ChannelBuffer] = {}
        for channel in read:
            if channel.name in own and not restarted:
                self._buffers[channel.index] = ChannelBuffer(channel)
            else:
                senders = (ports.host(self._writer_host[channel.index]), ports.host(ports.gateway))
                self._buffers[channel.index] = self._listen(channel, senders)
        self.local = {channel.name: self._buffers[channel.index] for channel in local}
        self.fetched = 0
        """Messages that were lost on their way and came after a fetch."""
        self.lost = 0
        """Messages that no process has any more."""

    def close(self) -> None:
        """Releases all sockets."""
        for buffer in self._buffers.values():
            if isinstance(buffer, ChannelSocket):
                buffer.close()

    def advance(
        self, channels: Sequence[int], sequences: Sequence[int], voids: Sequence[void_t]
    ) -> list[ChannelBuffer]:
        """Takes over the marks of a tick; returns the buffers in which messages became visible."""
        for void in voids:
            buffer = self._buffers.get(void.channel)
            if buffer is not None:
                buffer.void(void.above_sequence, void.up_to_tick, void.before_incarnation)
        moved = []
        for index, sequence in zip(channels, sequences, strict=True):
            buffer = self._buffers.get(index)
            if buffer is not None and sequence > buffer.mark:
                buffer.mark = sequence
                moved.append(buffer)
        return moved

    def open(self, channel: ChannelPlan, writer_host: int | None = None) -> ChannelBuffer:
        """Begins to read a channel; its writer is on `writer_host`, or where the plan says."""
        if writer_host is None:
            writer_host = self._host_of(channel.writer)
        self._writer_host[channel.index] = writer_host
        # Its writer may change before this host is informed, so every process of the run may send.
        buffer = self._buffers[channel.index] = self._listen(channel, self._ports.members)
        return buffer

    def _listen(self, channel: ChannelPlan, senders: Container[int]) -> ChannelSocket:
        source = self._network.group_socket(self._ports.channel(channel.index))
        return ChannelSocket(channel, source, senders, self._complain)

    def set_writer(self, channel: int, writer_host: int) -> None:
        """Fetches lost messages of a channel from another host from now on."""
        if channel in self._buffers:
            self._writer_host[channel] = writer_host

    def close_channel(self, channel: int) -> None:
        """Ends reading a channel."""
        buffer = self._buffers.pop(channel)
        if isinstance(buffer, ChannelSocket):
            buffer.close()

    def __contains__(self, channel: int) -> bool:
        return channel in self._buffers

    def _host_of(self, writer: int) -> int:
        return self._ports.gateway if writer == NOBODY else self._plan.components[writer].host

    def buffer(self, channel: int) -> ChannelBuffer:
        """Returns the buffer of the channel with this index."""
        return self._buffers[channel]

    def keep_newest(self) -> None:
        """Drops every visible message but the newest of each channel, as the catch-up rule wants it."""
        for buffer in self._buffers.values():
            buffer.keep_newest()

    def forget_predecessor(self) -> None:
        """Stops listening to this host's own channels, as no message of a predecessor is missing any more."""
        for buffer in self.local.values():
            if isinstance(buffer, ChannelSocket):
                buffer.close()

    def collect(self, buffers: Sequence[ChannelBuffer]) -> list[ChannelBuffer]:
        """Takes everything visible in `buffers` from their sockets; returns the buffers that still lack messages."""
        return [buffer for buffer in buffers if not buffer.collect()]

    def fetch(self, lacking: Sequence[ChannelBuffer], serve: Callable[[], bool]) -> Steps[bool]:
        """Fetches until everything visible in `lacking` is here; returns False if `serve` ends the wait.

        `serve` is called at every wake-up, because a waiting host must still answer others. In real time a writer
        that has stopped is not waited for: after a while the gateway is asked, and messages that it does not have are
        lost.
        """
        network = self._network
        watched = [buffer for buffer in lacking if isinstance(buffer, ChannelSocket) and not buffer.closed]
        for buffer in watched:
            network.watch(buffer)
        began_us = network.now_us()
        fetches = Backoff(began_us, FIRST_WAIT_US, self._longest_wait_us, SECOND_WAIT_US)
        fetched = 0
        while lacking:
            yield min(fetches.due_us, self._sender.due_us)
            self._sender.send_due()
            if not serve():
                break
            lacking = self.collect(lacking)
            for buffer in [each for each in watched if each not in lacking]:  # a later message would end every wait
                network.unwatch(buffer)
                watched.remove(buffer)
            now_us = network.now_us()
            if lacking and now_us >= fetches.due_us:
                fetched = max(fetched, sum(len(buffer.missing()) for buffer in lacking))
                fetches.repeated(now_us)
                self._fetch_all(lacking, self._asks_writer(began_us, fetches.due_us))
        for buffer in watched:
            network.unwatch(buffer)
        self.fetched += fetched
        return not lacking

    def _asks_writer(self, began_us: int, due_us: int) -> bool:
        """Returns whether a writer still has time to answer before it counts as stopped."""
        return not self._writer_timeout_us or due_us < began_us + self._writer_timeout_us

    def gone(self, message: gone_t) -> int:
        """Takes the answer that messages are no longer kept; returns how many are lost by it."""
        buffer = self._buffers.get(message.channel)
        lost = buffer.give_up(message.first_sequence, message.last_sequence) if buffer else 0
        self.lost += lost
        return lost

    def have(self, marks: Sequence[tuple[int, int]], host: int) -> bool:
        """Returns whether all messages up to these marks are here, visible or not; fetches missing ones from `host`."""
        complete = True
        for index, sequence in marks:
            buffer = self._buffers[index]
            missing = buffer.lacks(sequence)
            if missing:
                complete = False
                self._fetch(buffer, missing, host)
        return complete

    def new_losses(self) -> list[tuple[int, int]]:
        """Returns channel and sequence number of visible messages that never came, each once."""
        found = []
        for index, buffer in self._buffers.items():
            if buffer.lost:
                found += [(index, number) for number in buffer.lost]
                buffer.lost = []
        return found

    def _fetch_all(self, lacking: Sequence[ChannelBuffer], from_writer: bool) -> None:
        for buffer in lacking:
            missing = buffer.missing()
            if missing:
                host = self._writer_host[buffer.plan.index] if from_writer else self._ports.gateway
                self._fetch(buffer, missing, host)

    def _fetch(self, buffer: ChannelBuffer, missing: Sequence[int], host: int) -> None:
        fetch = fetch_t()
        fetch.run, fetch.host, fetch.channel = self._run, self._host, buffer.plan.index
        fetch.first_sequence, fetch.last_sequence = missing[0], missing[-1]
        self._sender.send(b"fwk/fetch", fetch.encode(), self._ports.host(host))

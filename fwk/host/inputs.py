"""The channels that a host reads: collects what the marks name and fetches what was lost."""

from collections.abc import Callable, Container, Sequence

from fwk.bus.channel_socket import ChannelSocket, Complain
from fwk.bus.network import Network, Steps
from fwk.bus.sender import Sender
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t, void_t

FIRST_WAIT_US = 200  # on one machine a message is there before the tick that names it, unless it was lost
SECOND_WAIT_US = 2_000
LONGEST_WAIT_US = 100_000
PATIENCE_US = 500_000  # in real time: who has not answered by then perhaps stands still


class Inputs:
    """The channels that a process reads, whether from other processes or from itself (`local`).

    A process that was started in the place of another (`restarted`) may have to ask for messages of its own channels,
    too: those of its predecessor.
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
        self._patience_us = PATIENCE_US if plan.clock == "wall" else 0
        self._host = host
        self._run = run
        self._plan = plan
        self._complain = complain
        self._writer_host = {channel.index: self._host_of(channel.writer) for channel in read}
        own = {channel.name for channel in local}
        self._boxes: dict[int, ChannelBuffer] = {}
        for channel in read:
            if channel.name in own and not restarted:
                self._boxes[channel.index] = ChannelBuffer(channel)
            else:
                senders = (ports.host(self._writer_host[channel.index]), ports.host(ports.gateway))
                self._boxes[channel.index] = self._listen(channel, senders)
        self.local = {channel.name: self._boxes[channel.index] for channel in local}
        self.fetched = 0  # messages that were lost and came after asking
        self.lost = 0  # messages that could not be had any more

    def close(self) -> None:
        """Gives all sockets back."""
        for box in self._boxes.values():
            if isinstance(box, ChannelSocket):
                box.close()

    def advance(
        self, channels: Sequence[int], sequences: Sequence[int], voids: Sequence[void_t]
    ) -> list[ChannelBuffer]:
        """Takes over a tick's marks; returns the boxes in which something becomes visible."""
        for void in voids:
            box = self._boxes.get(void.channel)
            if box is not None:
                box.void(void.above_sequence, void.up_to_tick, void.before_incarnation)
        moved = []
        for index, sequence in zip(channels, sequences, strict=True):
            box = self._boxes.get(index)
            if box is not None and sequence > box.mark:
                box.mark = sequence
                moved.append(box)
        return moved

    def open(self, channel: ChannelPlan, writer_host: int | None = None) -> ChannelBuffer:
        """From now on a channel is read that was not.

        Its messages come from that host; without one from where the plan says.
        """
        if writer_host is None:
            writer_host = self._host_of(channel.writer)
        self._writer_host[channel.index] = writer_host
        # Its writer may change, sooner than this process hears of it: whatever comes from the run is taken.
        box = self._boxes[channel.index] = self._listen(channel, self._ports.members)
        return box

    def _listen(self, channel: ChannelPlan, senders: Container[int]) -> ChannelSocket:
        source = self._network.group_socket(self._ports.channel(channel.index))
        return ChannelSocket(channel, source, senders, self._complain)

    def comes_from(self, channel: int, writer_host: int) -> None:
        """Another process writes a channel from now on, and is asked for what is lost of it."""
        if channel in self._boxes:
            self._writer_host[channel] = writer_host

    def close_channel(self, channel: int) -> None:
        """Nobody here reads a channel any more."""
        box = self._boxes.pop(channel)
        if isinstance(box, ChannelSocket):
            box.close()

    def __contains__(self, channel: int) -> bool:
        return channel in self._boxes

    def _host_of(self, writer: int) -> int:
        return self._ports.gateway if writer == NOBODY else self._plan.components[writer].host

    def box(self, channel: int) -> ChannelBuffer:
        """The channel with that index."""
        return self._boxes[channel]

    def newest_only(self) -> None:
        """For a late joiner: of what is visible already it wants the newest."""
        for box in self._boxes.values():
            box.skip_to(box.mark - 1)

    def forget_predecessor(self) -> None:
        """From now on what this process reads of itself never comes from outside."""
        for box in self.local.values():
            if isinstance(box, ChannelSocket):
                box.close()

    def collect(self, boxes: Sequence[ChannelBuffer]) -> list[ChannelBuffer]:
        """Takes everything visible in `boxes` from their sockets; returns the boxes that still lack messages."""
        return [box for box in boxes if not box.collect()]

    def fetch(self, lacking: Sequence[ChannelBuffer], serve: Callable[[], bool]) -> Steps[bool]:
        """Fetches until everything visible in `lacking` is here; returns False if `serve` says that waiting is over.

        `serve` is called at every wake-up, because a host that waits must still answer others. In real time a writer
        that stands still is not waited for: after a while the gateway is asked, and what it does not have is lost.
        """
        network = self._network
        watched = [box for box in lacking if isinstance(box, ChannelSocket) and not box.closed]
        for box in watched:
            network.watch(box)
        began_us = network.now_us()
        next_us, ask_us, asked = SECOND_WAIT_US, began_us + FIRST_WAIT_US, 0
        while lacking:
            yield min(ask_us, self._sender.due_us)
            self._sender.send_due()
            if not serve():
                break
            lacking = self.collect(lacking)
            for box in [each for each in watched if each not in lacking]:  # what comes later would end every wait
                network.unwatch(box)
                watched.remove(box)
            if lacking and network.now_us() >= ask_us:
                asked = max(asked, sum(len(box.missing()) for box in lacking))
                ask_us = network.now_us() + next_us
                self._ask(lacking, patient=not self._patience_us or ask_us < began_us + self._patience_us)
                next_us = min(2 * next_us, LONGEST_WAIT_US)
        for box in watched:
            network.unwatch(box)
        self.fetched += asked
        return not lacking

    def gone(self, message: gone_t) -> int:
        """A writer no longer has some messages; returns how many were lost by that."""
        box = self._boxes.get(message.channel)
        lost = box.give_up(message.first_sequence, message.last_sequence) if box else 0
        self.lost += lost
        return lost

    def have(self, marks: Sequence[tuple[int, int]]) -> bool:
        """Whether everything up to these numbers of channels is here, visible or not; asks for what is not."""
        lacking = []
        for index, sequence in marks:
            missing = self._boxes[index].lacks(sequence)
            if missing:
                lacking.append((self._boxes[index], missing))
        for box, missing in lacking:
            self._fetch(box, missing, self._writer_host[box.plan.index])
        return not lacking

    def missed(self) -> list[tuple[int, int]]:
        """Channel and sequence number of visible messages that never came, each once."""
        found = []
        for index, box in self._boxes.items():
            if box.missed:
                found += [(index, number) for number in box.missed]
                box.missed = []
        return found

    def _ask(self, lacking: Sequence[ChannelBuffer], *, patient: bool) -> None:
        for box in lacking:
            missing = box.missing()
            if missing:
                self._fetch(box, missing, self._writer_host[box.plan.index] if patient else self._ports.gateway)

    def _fetch(self, box: ChannelBuffer, missing: Sequence[int], host: int) -> None:
        fetch = fetch_t()
        fetch.run, fetch.host, fetch.channel = self._run, self._host, box.plan.index
        fetch.first_sequence, fetch.last_sequence = missing[0], missing[-1]
        self._sender.send(b"fwk/fetch", fetch.encode(), self._ports.host(host))

"""The ledger of marks: visible sequence numbers of all channels, and the marks that each stage has been sent."""

from bisect import bisect_left, insort
from dataclasses import dataclass

from fwk.model.channel_table import ChannelTable
from fwk.model.plan import Plan


@dataclass(frozen=True)
class Void:
    """The messages above the mark of a writer that died."""

    channel: int
    above_sequence: int
    up_to_tick: int
    before_incarnation: int
    since: int


class Visibility:
    """Marks of all channels.

    `step` counts stages begun. Messages that dones publish while a stage runs become visible when the next stage
    begins, and not before: a repeated tick is identical to the first. A host is sent the changes since the step of
    the last tick that it answered.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.step = 0
        channels = len(plan.channels) + plan.spare_channels
        self.marks = [0] * channels
        """Highest visible sequence number of each channel."""
        self.voids: list[Void] = []
        """All voids of the run, in the order of their steps."""
        self._latest = [0] * channels  # published, visible from the next step on
        self._dirty: list[int] = []
        self._changed = [-1] * channels  # step at which the mark moved last; -1: never
        self._interest: list[list[int]] = []
        self._hosts: list[set[int]] = []  # that take part in each stage
        for stage in range(len(plan.stages)):
            hosts = {component.host for component in plan.components if stage in component.stages}
            self._hosts.append(hosts)
            # All components of these hosts, not only those of the stage: the newest marks that a host has are one step
            # for all.
            members = {component.index for component in plan.components if component.host in hosts}
            self._interest.append([channel.index for channel in plan.channels if members & set(channel.readers)])
        self._read: list[list[int]] = [
            [channel.index for channel in plan.channels if set(host.components) & set(channel.readers)]
            for host in plan.hosts
        ]
        self._written: list[list[int]] = [
            [channel.index for channel in plan.channels if channel.writer in host.components] for host in plan.hosts
        ]
        self._declared_interest = [list(channels) for channels in self._interest]
        self._declared_read = [list(channels) for channels in self._read]

    def begin(self) -> int:
        """Begins a stage, to which everything published so far is visible; returns its step."""
        self.step += 1
        for channel in self._dirty:
            self.marks[channel] = self._latest[channel]
            self._changed[channel] = self.step
        self._dirty = []
        return self.step

    def publish(self, channel: int, sequence: int) -> bool:
        """Makes messages visible to stages that begin from now on; returns whether they were not published before."""
        if sequence <= self._latest[channel]:
            return False
        self._latest[channel] = sequence
        self._dirty.append(channel)
        return True

    def latest(self, channel: int) -> int:
        """Returns the sequence number of the newest message of a channel that a done has named."""
        return self._latest[channel]

    def news(self, stage: int, since: int) -> tuple[list[int], list[int]]:
        """Returns the channels read in a stage whose marks moved after step `since`, and the marks."""
        changed, marks = self._changed, self.marks
        channels = [channel for channel in self._interest[stage] if changed[channel] > since]
        return channels, [marks[channel] for channel in channels]

    def news_of(self, host: int, since: int) -> tuple[list[int], list[int]]:
        """Returns the channels read by a host whose marks moved after step `since`, and the marks."""
        channels = [channel for channel in self._read[host] if self._changed[channel] > since]
        return channels, [self.marks[channel] for channel in channels]

    def opened(self, table: ChannelTable) -> None:
        """Takes over the readers and writers of dynamic channels; stages are told from the next step on."""
        for lists, before in ((self._interest, self._declared_interest), (self._read, self._declared_read)):
            for place, channels in enumerate(before):
                lists[place] = list(channels)
        for state in table.matching("*"):
            for component in dict.fromkeys(component for component, _ in state.readers):
                self._opened_by(state.index, component)
            if state.writer:
                host = self.plan.components[state.writer[0]].host
                for channels in self._written:
                    if state.index in channels:
                        channels.remove(state.index)
                self._written[host].append(state.index)

    def _opened_by(self, channel: int, component: int) -> None:
        host = self.plan.components[component].host
        concerned = [self._read[host]]
        concerned += [self._interest[stage] for stage, hosts in enumerate(self._hosts) if host in hosts]
        for channels in concerned:
            if channel not in channels:
                insort(channels, channel)
        if self.marks[channel]:
            self._changed[channel] = self.step + 1  # a new reader has no marks yet

    def void(self, host: int, incarnation: int, tick: int) -> None:
        """Voids the messages above the marks of a host that died in the newest tick; `incarnation` is its next."""
        for channel in self._written[host]:
            self.voids.append(Void(channel, self._latest[channel], tick, incarnation, self.step))

    def voids_since(self, since: int) -> list[Void]:
        """Returns the voids that a host whose last tick was of step `since` may not know."""
        if not self.voids:
            return []
        return self.voids[bisect_left(self.voids, since, key=lambda void: void.since) :]

    def sequences(self, host: int) -> dict[str, int]:
        """Returns the sequence numbers at which a restarted host continues, by channel."""
        declared = [channel for channel in self._written[host] if channel < len(self.plan.channels)]
        return {self.plan.channels[channel].name: self._latest[channel] for channel in declared}

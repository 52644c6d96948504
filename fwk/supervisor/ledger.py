"""The ledger of marks: which sequence number of each channel is visible, and what a stage has to be told of it."""

from dataclasses import dataclass, field

from fwk.plan.model import Plan


@dataclass(frozen=True)
class Void:
    """What a writer that died had sent above the mark is void."""

    channel: int
    above_sequence: int
    before_incarnation: int
    since: int


@dataclass
class Ledger:
    """Marks of all channels. `step` counts stages begun; who takes part is told what changed since it was told last."""

    plan: Plan
    step: int = 0
    marks: list[int] = field(default_factory=list)
    voids: list[Void] = field(default_factory=list)

    def __post_init__(self) -> None:
        plan = self.plan
        self.marks = [0] * len(plan.channels)
        self._changed = [-1] * len(plan.channels)  # never
        self._interest: list[list[int]] = []
        for stage in range(len(plan.stages)):
            members = {component.index for component in plan.components if stage in component.stages}
            self._interest.append([channel.index for channel in plan.channels if members & set(channel.readers)])
        self._written: list[list[int]] = [
            [channel.index for channel in plan.channels if channel.writer in host.components] for host in plan.hosts
        ]

    def begin(self) -> int:
        """Begins a stage; returns its step."""
        self.step += 1
        return self.step

    def publish(self, channel: int, sequence: int) -> None:
        """A writer's done makes its messages visible to the stages that begin from now on."""
        if sequence > self.marks[channel]:
            self.marks[channel] = sequence
            self._changed[channel] = self.step

    def news(self, stage: int, since: int) -> tuple[list[int], list[int]]:
        """Channels read in a stage that changed in or after step `since`, and their marks."""
        changed, marks = self._changed, self.marks
        channels = [channel for channel in self._interest[stage] if changed[channel] >= since]
        return channels, [marks[channel] for channel in channels]

    def void(self, host: int, incarnation: int) -> None:
        """A host died; its next start is `incarnation`."""
        self.voids += [Void(channel, self.marks[channel], incarnation, self.step) for channel in self._written[host]]

    def voids_since(self, since: int) -> list[Void]:
        """Voids that somebody who saw step `since` last may not know."""
        return [void for void in self.voids if void.since >= since]

    def sequences(self, host: int) -> dict[str, int]:
        """Where a restarted host's channels go on."""
        return {self.plan.channels[channel].name: self.marks[channel] for channel in self._written[host]}

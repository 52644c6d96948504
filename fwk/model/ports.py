"""The UDP port numbers of a run."""

from dataclasses import dataclass

from fwk.model.plan import Plan

STAGES_MAX = 30


@dataclass(frozen=True)
class Ports:
    """All ports of a run, counted from its bus port.

    A host sends from its own port; so does the gateway, which is the host after the last.
    """

    base: int
    hosts: int
    channels: int

    @classmethod
    def of(cls, plan: Plan) -> "Ports":
        """The ports of a plan."""
        return cls(plan.bus_port, len(plan.hosts), len(plan.channels) + plan.spare_channels)

    @property
    def sync(self) -> int:
        """Dones and states, to the supervisor."""
        return self.base

    def stage(self, index: int) -> int:
        """Ticks of a stage."""
        return self.base + 1 + index

    @property
    def record(self) -> int:
        """Tick records, to recorder and gateway."""
        return self.base + 1 + STAGES_MAX

    @property
    def log(self) -> int:
        """Lines of text."""
        return self.record + 1

    @property
    def status(self) -> int:
        """The supervisor's view of the run."""
        return self.record + 2

    @property
    def supervisor(self) -> int:
        """The port that the supervisor sends from."""
        return self.record + 3

    def host(self, index: int) -> int:
        """The port that a host sends from and can be asked at."""
        return self.supervisor + 1 + index

    @property
    def gateway(self) -> int:
        """The gateway's host index."""
        return self.hosts

    @property
    def members(self) -> range:
        """All ports that processes of the run send from."""
        return range(self.supervisor, self.host(self.gateway) + 1)

    def channel(self, index: int) -> int:
        """Messages of a channel."""
        return self.host(self.hosts + 1) + index

    @property
    def end(self) -> int:
        """The first port that the run does not use."""
        return self.channel(self.channels)

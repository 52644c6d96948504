"""UDP port numbers of a run."""

from dataclasses import dataclass
from functools import cached_property

from fwk.model.plan import Plan

STAGES_MAX = 30


@dataclass(frozen=True)
class Ports:
    """The ports of a run, counted from its bus port.

    A host sends from its own port; so does the gateway, which is the host after the last.
    """

    base: int
    hosts: int
    channels: int

    @classmethod
    def of(cls, plan: Plan) -> "Ports":
        """Returns the ports of a plan."""
        return cls(plan.bus_port, len(plan.hosts), len(plan.channels) + plan.spare_channels)

    @property
    def sync(self) -> int:
        """Port of dones and states, to the supervisor."""
        return self.base

    def stage(self, index: int) -> int:
        """Returns the port of the ticks of a stage."""
        return self.base + 1 + index

    @cached_property
    def record(self) -> int:
        """Port of tick records, to the gateway."""
        return self.base + 1 + STAGES_MAX

    @property
    def log(self) -> int:
        """Port of log lines."""
        return self.record + 1

    @property
    def status(self) -> int:
        """Port of the supervisor's status."""
        return self.record + 2

    @cached_property
    def supervisor(self) -> int:
        """The port that the supervisor sends from."""
        return self.record + 3

    def host(self, index: int) -> int:
        """Returns the port that a host sends from and receives fetches at."""
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
        """Returns the port of a channel's messages."""
        return self._first_channel + index

    @cached_property
    def _first_channel(self) -> int:
        return self.host(self.hosts + 1)

    @property
    def end(self) -> int:
        """The first port that the run does not use."""
        return self.channel(self.channels)

"""Data that all parts of a supervisor share."""

from collections.abc import Callable
from dataclasses import dataclass

from fwk.bus.sender import Sender
from fwk.component.log import Logger
from fwk.engine.visibility import Visibility
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.run_clock import RunClock


@dataclass(frozen=True)
class Core:
    """The plan and its run number, the bus, the clock, the marks, the table of hosts and the log."""

    plan: Plan
    run: int
    ports: Ports
    events: EventLoop
    sender: Sender
    clock: RunClock
    ledger: Visibility
    hosts: list[HostProcess]
    """All host processes, by index."""
    log: Logger
    interrupted: Callable[[], bool]
    """Whether the run is asked to end; from then on no wait continues."""
    now_us: Callable[[], int]
    """Returns the wall time in microseconds."""

    @property
    def lockstep(self) -> bool:
        """Whether a stage waits for all hosts, however long that takes."""
        return self.plan.clock == "simulated"

    def host_of(self, component: int) -> HostProcess:
        """Returns the host of the component with that index."""
        return self.hosts[self.plan.components[component].host]

    def components_of(self, host: HostProcess) -> tuple[int, ...]:
        """Returns the indices of a host's components."""
        return self.plan.hosts[host.index].components

    def stages_of(self, host: HostProcess) -> set[int]:
        """Returns the stages of a host's components."""
        return {stage for index in self.components_of(host) for stage in self.plan.components[index].stages}

"""The supervisor's view of the run, published twice a second."""

from copy import copy

from fwk.clock import US_PER_S
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.loop import Loop
from lcmtypes.core import component_state_t, host_status_t, status_t

PERIOD_US = US_PER_S // 2


class StatusReport:
    """Makes status messages and measures the speed of the run."""

    def __init__(self, core: Core, loop: Loop) -> None:
        self._core = core
        self._loop = loop
        self._began_us = core.now_us()
        self._before = (self._began_us, 0, 0)  # wall time, tick and logical time of the last message

    @property
    def due(self) -> bool:
        """Returns whether it is time for the next message."""
        return self._core.now_us() >= self._before[0] + PERIOD_US

    @property
    def wall_s(self) -> float:
        """Wall time since the loop began, in seconds."""
        return (self._core.now_us() - self._began_us) / US_PER_S

    def message(self) -> status_t:
        """Returns the state of the run now."""
        now_us = self._core.now_us()
        wall_us, tick, time_us = self._before
        self._before = (now_us, self._loop.tick, self._core.clock.time_us)
        made = status_t()
        made.run, made.tick, made.time_us = self._core.run, self._loop.tick, self._core.clock.time_us
        elapsed_us = max(1, now_us - wall_us)
        made.speed = (self._core.clock.time_us - time_us) / elapsed_us
        made.ticks_per_s = (self._loop.tick - tick) * US_PER_S / elapsed_us
        made.repeated, made.late = self._loop.barrier.repeated, self._loop.barrier.late
        made.paused = self._loop.paused
        made.waits_for = self._loop.components_waited_for
        made.n_waits_for = len(made.waits_for)
        made.hosts = [_host(entry) for entry in self._core.hosts]
        made.n = len(made.hosts)
        return made

    def complete(self, status: status_t) -> None:
        """Updates the figures of an earlier message to the newest reports of the hosts; its states stay."""
        for host, entry in zip(status.hosts, self._core.hosts, strict=True):
            host.counters = entry.counters
            newest = {component.name: component for component in entry.components}
            for component in host.components:
                last = newest.get(component.name, component)
                component.iterations, component.busy_us = last.iterations, last.busy_us
                component.awake_us, component.worst_us = last.awake_us, last.worst_us
                component.lost_frames = last.lost_frames


def _host(entry: HostProcess) -> host_status_t:
    made = host_status_t()
    made.host, made.pid, made.restarts = entry.index, entry.pid, entry.restarts
    made.counters = entry.counters
    made.state = "late" if entry.late_with else entry.state
    made.components = list(entry.components)
    if entry.held and entry.alive:
        made.state, made.components = "held", [_held(component) for component in entry.components]
    made.n = len(made.components)
    return made


def _held(component: component_state_t) -> component_state_t:
    made = copy(component)
    made.state, made.reason = "held", component.reason or "a debugger has its process"
    return made

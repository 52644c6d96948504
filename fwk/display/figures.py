"""Sums over a status message: states, losses, restarts, and the slowest components."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from lcmtypes.core import component_state_t, host_status_t, status_t

WELL = ("init", "loaded", "running", "finalizing", "stopped")
_UNWELL_FIRST = ("failed", "held")


@dataclass(frozen=True)
class Totals:
    """Sums over all hosts."""

    lost: int
    """Messages and camera frames lost for good."""
    fetched: int
    """Messages that were lost and fetched again."""
    foreign: int
    """Datagrams refused."""


@dataclass(frozen=True)
class LoopTime:
    """Time that a component's iterations take, in milliseconds of wall time."""

    name: str
    mean_ms: float
    worst_ms: float


def components(status: status_t) -> list[component_state_t]:
    """Returns all components, in the order of the hosts."""
    return [component for host in status.hosts for component in host.components]


def restarts(status: status_t) -> int:
    """Returns how often hosts were started again."""
    return sum(host.restarts for host in status.hosts)


def states(some: Iterable[component_state_t]) -> dict[str, int]:
    """Returns state to number of components in it, failed and held first."""
    counted = Counter(component.state for component in some)
    order = sorted(counted, key=lambda state: (state not in _UNWELL_FIRST, state))
    return {state: counted[state] for state in order}


def totals(status: status_t) -> Totals:
    """Returns sums over all hosts."""
    return Totals(
        lost(status.hosts, components(status)),
        sum(host.counters.fetched for host in status.hosts),
        sum(host.counters.foreign for host in status.hosts),
    )


def lost(hosts: Iterable[host_status_t], of: Iterable[component_state_t]) -> int:
    """Returns how many messages these hosts and camera frames these components have lost."""
    return sum(host.counters.lost for host in hosts) + sum(component.lost_frames for component in of)


def loop_times(status: status_t, since: status_t | None = None) -> dict[str, LoopTime]:
    """Returns the loop time of each component since an earlier status, or since it started, in ms of wall time."""
    before = {component.name: component for component in components(since)} if since else {}
    found = {}
    for component in components(status):
        busy_us, iterations = component.busy_us, component.iterations
        earlier = before.get(component.name)
        if earlier and 0 < earlier.iterations < iterations:  # otherwise it stands still or was restarted
            busy_us, iterations = busy_us - earlier.busy_us, iterations - earlier.iterations
        mean_ms = busy_us / iterations / 1000 if iterations else 0.0
        found[component.name] = LoopTime(component.name, mean_ms, component.worst_us / 1000)
    return found


def slowest(times: dict[str, LoopTime], count: int) -> list[LoopTime]:
    """Returns the components with the longest mean loop time, longest first."""
    return sorted(times.values(), key=lambda time: (-time.mean_ms, time.name))[:count]

"""A run and its components as plain data, for replies to control requests."""

from collections.abc import Sequence
from typing import Any

from fwk.clock import US_PER_S
from fwk.model.histogram import Histogram
from fwk.model.plan import ComponentPlan, Plan
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.loop_times import LoopTimes
from lcmtypes.core import component_state_t


def component_view(plan: Plan, component: ComponentPlan, entry: HostProcess) -> dict[str, Any]:
    """State and figures of one component; times of iterations are wall time."""
    told = next((item for item in entry.components if item.name == component.name), component_state_t())
    return {
        "name": component.name,
        "state": _state(entry, told),
        "wanted": "running" if entry.wanted else "stopped",
        "period_s": period_us(plan, component) / US_PER_S,
        "stages": [plan.stages[stage] for stage in component.stages],
        "rate_hz": component.rate_hz,
        "every": component.every,
        "offset": component.offset,
        "process": entry.name,
        "pid": entry.pid,
        "starts": entry.incarnation,
        "restarts": entry.restarts,
        "iterations": told.iterations,
        "mean_ms": told.busy_us / told.iterations / 1000 if told.iterations else 0.0,
        "worst_ms": told.worst_us / 1000,
        "awake_s": told.awake_us / US_PER_S if entry.pid else 0.0,
        "fetched": entry.counters.fetched,  # this and the next two are those of the whole process
        "lost": entry.counters.lost + told.lost_frames,
        "strangers": entry.counters.foreign,
        "reason": told.reason or entry.reason,
        "needs": [plan.components[index].name for index in component.needs],
    }


def period_us(plan: Plan, component: ComponentPlan) -> int:
    """Time between iterations; 0 if a component continues as fast as it can."""
    if component.rate_hz is None:
        return plan.period_us * component.every
    return round(US_PER_S / component.rate_hz) if component.rate_hz else 0


def times_view(plan: Plan, times: LoopTimes, table: Sequence[HostProcess]) -> dict[str, Any]:
    """Histograms of wall time, as `Histogram.to_json`: of ticks, of the stages that ran, and of components."""
    stages = [(plan.stages[index], histogram) for index, histogram in enumerate(times.stages) if histogram.count]
    components = {}
    for entry in table:
        for told, counted in zip(entry.components, entry.times, strict=True):
            counts = zip(counted.bucket, counted.count, strict=True)
            components[told.name] = Histogram.of(counts, told.busy_us, told.worst_us).to_json()
    return {
        "loop": times.loop.to_json(),
        "cycle": times.cycle.to_json(),
        "stages": {name: histogram.to_json() for name, histogram in stages},
        "components": components,
    }


def _state(entry: HostProcess, told: component_state_t) -> str:
    if entry.held and entry.alive:
        return "held"
    if entry.late_with:
        return "late"
    if entry.state in ("starting", "running", "stopping") and told.state:
        return told.state
    return "failed" if told.state == "failed" and entry.state == "failed" else entry.state

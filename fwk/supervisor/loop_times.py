"""Durations of stages and ticks, and warnings about slow ones."""

import sys
from collections.abc import Sequence

from fwk.clock import US_PER_S
from fwk.component.log import Logger
from fwk.model.histogram import Histogram
from fwk.model.plan import Plan
from fwk.supervisor.host_process import HostProcess

TOLERANCE = 1.1  # a tick up to this much longer than desired gives no warning
_QUIET_US = 10 * US_PER_S
_OVERRUNS_SAID = 10


class Limited:
    """Lets some warnings of a kind through at once, then one every ten seconds, and counts those in between."""

    def __init__(self, at_once: int) -> None:
        self.left_out = 0
        self._at_once = at_once
        self._quiet_until_us = 0

    def lets_through(self, now_us: int) -> bool:
        """Returns whether a warning may be logged now; if not, it is counted."""
        if self._at_once > 0:
            self._at_once -= 1
        elif now_us < self._quiet_until_us:
            self.left_out += 1
            return False
        self._quiet_until_us = now_us + _QUIET_US
        return True

    def between(self) -> str:
        """Returns the number of warnings left out since the last one, as text, and resets it."""
        left_out, self.left_out = self.left_out, 0
        return f" ({left_out} more since the last such line)" if left_out else ""


class LoopTimes:
    """Histograms of wall time by stage, and of whole ticks.

    Warns of a tick that takes longer than desired, with its slowest stage and component, and of a component that takes
    longer than a stage may.
    """

    def __init__(self, plan: Plan, table: Sequence[HostProcess], log: Logger) -> None:
        self.stages = [Histogram() for _ in plan.stages]
        self.loop = Histogram()
        """From the beginning of a tick's first stage to the end of its last one."""
        self.cycle = Histogram()
        """From the beginning of a tick to the beginning of the next one."""
        self._plan = plan
        self._table = table
        self._log = log
        self._began_us = 0
        self._slowest_stage = (0, 0)  # of this tick: duration, stage
        self._slowest_host = (0, 0, 0)  # of this tick: duration, host, stage
        warns = plan.loop_time_warnings
        lockstep = plan.clock == "simulated"  # in real time the main loop itself names late hosts
        self._allowed_us = plan.stage_time_us if warns and lockstep and plan.stage_time_us else sys.maxsize
        self._warns = warns
        self._missed = Limited(1)
        self._overrun = [Limited(_OVERRUNS_SAID) for _ in table]
        self._said_late: set[int] = set()

    def tick_begins(self, now_us: int) -> None:
        """Notes the wall time at which a tick begins."""
        if self._began_us:
            self.cycle.add(now_us - self._began_us)
        self._began_us = now_us
        self._slowest_stage = (0, 0)
        self._slowest_host = (0, 0, 0)

    def answered(self, host: int, stage: int, busy_us: int, tick: int) -> None:
        """Notes the wall time of a host's iterations of a stage."""
        if busy_us > self._slowest_host[0]:
            self._slowest_host = (busy_us, host, stage)
        if busy_us > self._allowed_us and self._overrun[host].lets_through(self._began_us):
            self._log.warning(
                f"{self.name_of(host, stage)} overran its stage: {self._plan.stages[stage]} of tick {tick} took it "
                f"{busy_us / 1000:.1f} ms, allowed are {self._allowed_us / 1000:g} ms{self._overrun[host].between()}"
            )

    def stage_ended(self, stage: int, duration_us: int) -> None:
        """Notes the wall time of a stage."""
        self.stages[stage].add(duration_us)
        if duration_us > self._slowest_stage[0]:
            self._slowest_stage = (duration_us, stage)

    def tick_ended(self, tick: int, now_us: int, desired_us: float) -> None:
        """Notes the wall time at which a tick ends; `desired_us` is its desired duration, 0: no limit."""
        took_us = now_us - self._began_us
        self.loop.add(took_us)
        if not self._warns or not 0 < desired_us * TOLERANCE < took_us or any(entry.held for entry in self._table):
            return
        if tick == 1:  # memory and caches are cold everywhere
            return
        if self._missed.lets_through(now_us):
            stage_us, stage = self._slowest_stage
            busy_us, host, its_stage = self._slowest_host
            self._log.warning(
                f"loop time missed: tick {tick} took {took_us / 1000:.1f} ms, desired are {desired_us / 1000:.3g} ms; "
                f"slowest stage {self._plan.stages[stage]} ({stage_us / 1000:.1f} ms), "
                f"slowest component {self.name_of(host, its_stage)} ({busy_us / 1000:.1f} ms){self._missed.between()}"
            )

    def late(self, entry: HostProcess, stage: int, tick: int, allowed_us: int) -> None:
        """Reports that the loop goes on without a host in real time."""
        if entry.held:
            self._log.info(f"{entry.name} is held by its debugger in tick {tick}; the loop goes on")
        elif self._overrun[entry.index].lets_through(self._began_us):
            self._said_late.add(entry.index)
            self._log.warning(
                f"{entry.name} is late: {self._plan.stages[stage]} of tick {tick} took longer than "
                f"{allowed_us / 1000:g} ms; the loop goes on without it{self._overrun[entry.index].between()}"
            )

    def on_time_again(self, entry: HostProcess, tick: int, busy_us: int) -> None:
        """Reports that a late host has answered, if its lateness was reported."""
        if entry.held or entry.index in self._said_late:
            self._said_late.discard(entry.index)
            log = self._log.info if entry.held else self._log.warning
            log(f"{entry.name} is on time again; its tick {tick} took {busy_us / 1000:.1f} ms")

    def name_of(self, host: int, stage: int) -> str:
        """Returns the component of a host that takes longest in a stage, and its process if that has another name."""
        entry = self._table[host]
        members = [self._plan.components[index] for index in self._plan.hosts[host].components]
        busy_us = {each.name: each.busy_us / max(1, each.iterations) for each in entry.components}
        inside = [each.name for each in members if stage in each.stages] or [each.name for each in members]
        slowest = max(inside, key=lambda name: busy_us.get(name, 0.0))
        return slowest if slowest == entry.name else f"{slowest} in process {entry.name}"

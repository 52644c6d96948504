"""The main loop: runs ticks, one stage after the other."""

from collections.abc import Sequence

from fwk.bus.network import Steps
from fwk.engine.schedule import Schedule
from fwk.supervisor.barrier import Barrier
from fwk.supervisor.boundary import Boundary
from fwk.supervisor.continuous import ContinuousHosts
from fwk.supervisor.core import Core
from fwk.supervisor.dones import Dones
from fwk.supervisor.loop_times import LoopTimes
from fwk.supervisor.tick_log import TickLog, void_messages
from fwk.supervisor.tick_sender import Tick, Turn

PAUSED_US = 100_000
"""Interval of boundaries while the run is paused."""
FINISH_US = 2_000_000
"""Longest wait of an interrupted run for the gateway."""


class Loop:
    """Runs ticks as the page on the protocol describes."""

    def __init__(
        self,
        core: Core,
        boundary: Boundary,
        schedule: Schedule,
        barrier: Barrier,
        continuous: ContinuousHosts,
        dones: Dones,
        tick_log: TickLog,
        times: LoopTimes,
    ) -> None:
        self.boundary = boundary
        self.schedule = schedule
        self.barrier = barrier
        self.tick_log = tick_log
        self.times = times
        self.paused = False
        """Whether the run is paused and its newest tick has ended."""
        self._core = core
        self._continuous = continuous
        self._dones = dones
        stages = range(len(core.plan.stages))
        self._hosts = [[host for host in core.hosts if stage in core.stages_of(host)] for stage in stages]
        self._steps: Sequence[tuple[int, int]] = []
        self._turns: list[Turn] = []

    @property
    def tick(self) -> int:
        """Number of the newest tick."""
        return self._core.clock.tick

    @property
    def waits_for(self) -> list[str]:
        """Names of the hosts that the loop waits for longer than a moment, or the gateway."""
        return ["gateway"] if self.tick_log.stalled else [host.name for host in self.barrier.report.hosts]

    @property
    def components_waited_for(self) -> list[str]:
        """Full names of the components that the loop waits for longer than a moment, or the gateway."""
        return ["gateway"] if self.tick_log.stalled else self.barrier.report.components

    def run_tick(self) -> Steps[None]:
        """Runs the next tick when its time has come; while the run is paused, only crosses the boundary."""
        yield from self._until_due()
        yield from self.tick_log.wait_for(self.tick + 1 - self.barrier.window, self._core.interrupted)
        if self._core.interrupted():
            return
        self.paused = paused = self._core.clock.stands
        if paused:
            yield from self._core.events.wait(self._core.now_us() + PAUSED_US)
        yield from self.boundary.cross()
        if paused or self._core.interrupted():
            return
        tick = self._begin()
        for turn in self._scheduled():
            if not self._core.interrupted():
                yield from self.barrier.run(tick, turn)
        self._end(tick)

    def finish(self) -> Steps[None]:
        """Waits until the gateway has everything; an interrupted run waits for a limited time."""
        core, until_us = self._core, self._core.now_us() + FINISH_US
        yield from self.tick_log.wait_for(self.tick, lambda: core.interrupted() and core.now_us() >= until_us)

    def _until_due(self) -> Steps[None]:
        """Waits until the next tick may begin, or no tick may."""
        core, clock = self._core, self._core.clock
        begin_us = clock.begin_us(core.now_us())
        yield from core.events.wait(0)
        while not core.interrupted() and not clock.stands and begin_us > core.now_us():
            yield from core.events.wait_on_time(begin_us)
            begin_us = clock.begin_us(core.now_us())

    def _begin(self) -> Tick:
        """Begins a tick: late hosts are reminded, messages from outside and all published marks become visible."""
        self.barrier.sender.remind()
        now_us = self._core.now_us()
        time_us = self._core.clock.advance(now_us)
        tick = Tick(self.tick, time_us, self.schedule.holder)
        self._dones.take_in()
        self.times.tick_begins(now_us)
        self._continuous.tell(tick)
        return tick

    def _scheduled(self) -> list[Turn]:
        """Returns the turns of the running tick."""
        if self._steps is not self.schedule.steps:
            self._steps = self.schedule.steps
            self._turns = [Turn(step, stage, self._hosts[stage]) for step, stage in self._steps]
        return self._turns

    def _end(self, tick: Tick) -> None:
        """Ends a tick: its record goes to the gateway."""
        core = self._core
        desired_us = core.plan.loop_time_us or core.clock.loop_time_us
        self.times.tick_ended(tick.number, core.now_us(), desired_us)
        since = self.barrier.ledger_step - 4 * len(self._turns)
        self.tick_log.publish(tick.number, tick.time_us, void_messages(core.ledger, since))

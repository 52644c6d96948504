"""The main loop: one barrier a stage, in lockstep or in real time."""

from collections.abc import Callable, Sequence

from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.sender import Sender
from fwk.component.log import Logger
from fwk.engine.visibility import Ledger
from fwk.lcm.messages import MessageError
from fwk.model.channel_table import Fact
from fwk.model.plan import NOBODY, Plan
from fwk.model.ports import Ports
from fwk.model.requests import mistake_in
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    HostLate,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    OutsideTaken,
    StageBegun,
    StageDone,
)
from fwk.supervisor.channel_requests import Opening
from fwk.supervisor.continuous import Continuous
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.loop_times import LoopTimes
from fwk.supervisor.loss_report import Missed
from fwk.supervisor.processes.host_process import Change, HostEntry
from fwk.supervisor.processes.hosts import Hosts
from fwk.supervisor.retransmission_timeout import Patience
from fwk.supervisor.run_clock import Pace
from fwk.supervisor.schedule import Turns
from fwk.supervisor.sync_receiver import SyncReceiver
from fwk.supervisor.tick_log import Records, void_messages
from fwk.supervisor.tick_sender import Telling
from lcmtypes.core import done_t, recorded_t, taken_t

REPEAT_LONGEST_US = 100_000
LOOK_US = 20_000  # how often to look after hosts that are being started again, while a stage waits
WAITS_US = 200_000  # a stage that takes longer is said to wait
STUCK_US = 1_000_000  # how long what shall stop may keep the loop from its next boundary
STANDS_US = 100_000  # how often to look after hosts while the run is paused
WINDOW = 16  # ticks that the loop may be ahead of the gateway
REAL_TIME_WINDOW_US = 4_000_000  # in real time as many ticks as take so long: it goes on while somebody stands still
ANNOUNCE_US = 20_000  # how long a gateway that stands still may hold up real time when channels are opened
FINISH_US = 2_000_000  # how long an interrupted run waits for the gateway


class MainLoop:
    """Runs ticks. `interrupted` ends whatever it waits for."""

    def __init__(
        self,
        plan: Plan,
        run: int,
        hosts: Hosts,
        ledger: Ledger,
        events: EventLoop,
        receiver: SyncReceiver,
        sender: Sender,
        pace: Pace,
        log: Logger,
        interrupted: Callable[[], bool],
    ) -> None:
        self.tick = 0
        self.repeated = 0
        self.late = 0
        self.stands = False
        """Whether the run is paused and its newest tick has ended."""
        self.on_requests: Callable[[done_t], None] = lambda _: None
        """Called with each done that is taken."""
        self.on_boundary: Callable[[int], None] = lambda _: None
        """Called with the number of the tick that is about to begin; it may change settings, start and stop hosts."""
        self.on_wait: Callable[[], None] = lambda: None
        """Called again and again while a stage takes longer than a moment."""
        self.times = LoopTimes(plan, hosts.table, log)
        self._plan = plan
        self._hosts = hosts
        self._ledger = ledger
        self._events = events
        self._sender = sender
        self.pace = pace
        self._log = log
        self._interrupted = interrupted
        self._ports = Ports.of(plan)
        self._lockstep = plan.clock == "simulated"
        self._window = WINDOW if self._lockstep else max(WINDOW, REAL_TIME_WINDOW_US // plan.period_us)
        self._stage_time_us = plan.stage_time_us or plan.period_us
        by_stage = [
            [entry for entry in hosts.table if any(stage in plan.components[i].stages for i in self._members(entry))]
            for stage in range(len(plan.stages))
        ]
        self._patience = [Patience() for _ in plan.stages]
        self.turns = Turns(plan, by_stage, log)
        self._stage = 0
        self._place = 0  # of the running stage in the tick's order
        self._step = 0
        self._began_us = 0  # wall time at which the stage began
        self._outstanding: set[int] = set()
        self._again = False  # somebody joined the stage that runs: tell it at once
        self._came_in: dict[int, int] = {}  # marks of messages from outside, visible from the next tick on
        self.records = Records(self._ports, run, sender, events)
        self._telling = Telling(run, self._ports, ledger, sender)
        self._missed = Missed(self.records)
        continuous = Continuous(plan, run, hosts.table, ledger, sender, self.records)
        self._continuous = continuous if continuous.entries else None
        opens = any(component.opens for component in plan.components)
        self.opening = Opening(plan, hosts, ledger, self._change_blackboard, log) if opens else None
        if self.opening:
            hosts.blackboard = self.opening.snapshot
        self._sizes = len(plan.components), len(plan.channels) + plan.spare_channels, len(plan.stages)
        self.newest_change = 0
        """Number of the newest change of settings, or of the blackboard."""
        receiver.on_done = self._on_done
        receiver.on_recorded = self._on_recorded
        hosts.on_started = self._on_started
        hosts.on_lost = self._on_lost
        hosts.on_stopped = self._on_stopped

    @property
    def time_us(self) -> int:
        """Logical time of the newest tick."""
        return self.pace.time_us

    @property
    def waits_for(self) -> list[str]:
        """Names of the hosts that the running stage waits for longer than usual, or the gateway."""
        if self.records.stalled:
            return ["gateway"]
        if self._events.now_us() < self._began_us + WAITS_US:
            return []
        return [self._hosts.table[index].name for index in sorted(self._outstanding)]

    def change(self, component: int, settings: str) -> None:
        """At a tick boundary: new settings of a component, which its next iteration has."""
        self._tell(component, settings, [self._hosts.table[self._plan.components[component].host]])

    def _change_blackboard(self, facts: Sequence[Fact]) -> Change:
        """At a tick boundary: what is open from the next tick on."""
        concerned = [self._hosts.table[host] for host in {each.host for each in self._plan.components if each.opens}]
        change = self._tell(NOBODY, "", concerned, facts)
        self.records.event(ChannelsChanged(self.newest_change))
        return change

    def _tell(self, component: int, settings: str, concerned: list[HostEntry], facts: Sequence[Fact] = ()) -> Change:
        self.newest_change += 1
        change = Change(component, self.newest_change, settings, self._ledger.step + 1, facts)
        self.records.change(change)
        for entry in concerned:
            if entry.alive:
                entry.changes.append(change)
        return change

    def run_tick(self) -> Steps[None]:
        """Waits until the next tick may begin, then runs all its stages; while paused, does what is asked meanwhile."""
        yield from self._wait()
        yield from self.records.wait_for(self.tick + 1 - self._window, self._interrupted)
        if self._interrupted():
            return
        stands = self.stands = self.pace.stands
        if stands:
            yield from self._events.wait(self._events.now_us() + STANDS_US)
        if self._hosts.unsettled:
            self._hosts.maintain()
        self.on_boundary(self.tick + 1)
        self._hosts.steer()
        if stands:
            return
        if self._hosts.leaving and self._lockstep:
            yield from self._see_off()
        self._telling.remind(self._hosts.table)
        if self.turns.asked:
            self._decide()
        if self.opening and self.opening.asked:
            yield from self._decide_channels(self.opening)
        self.tick += 1
        if self._came_in:
            self._take_in()
        now_us = self._events.now_us()
        time_us = self.pace.advance(now_us)
        self.times.tick_begins(now_us)
        if self._continuous:
            self._continuous.tell(self.tick, time_us, self.turns.holder)
        for place, stage, members in self.turns.now:
            if not self._interrupted():
                self._place = place
                yield from self._run_stage(stage, members, time_us)
        self.times.tick_ended(self.tick, self._events.now_us(), self._plan.loop_time_us or self.pace.loop_time_us)
        self.records.publish(self.tick, time_us, void_messages(self._ledger, self._step - 4 * len(self.turns.now)))

    def finish(self) -> Steps[None]:
        """Waits until the gateway has everything; for one that is far behind not for ever if the run is interrupted."""
        until_us = self._events.now_us() + FINISH_US
        yield from self.records.wait_for(self.tick, lambda: self._interrupted() and self._events.now_us() >= until_us)

    def _decide_channels(self, opening: Opening) -> Steps[None]:
        """At the boundary: which channels are open from the next tick on; the gateway listens to new ones first."""
        announced = opening.decide()
        if announced:
            longest_us = 0 if self._lockstep else ANNOUNCE_US
            yield from self.records.announce(announced, longest_us, self._interrupted)

    def _decide(self) -> None:
        """At the boundary: who has the main loop from the next tick on."""
        if self.turns.decide(self.tick + 1):
            self.records.event(MainLoopGiven(self.turns.holder))

    def _members(self, entry: HostEntry) -> tuple[int, ...]:
        return self._plan.hosts[entry.index].components

    def _take_in(self) -> None:
        """At the beginning of a tick: what came from outside becomes visible to all its stages."""
        came_in, self._came_in = self._came_in, {}
        moved = {channel: number for channel, number in came_in.items() if self._ledger.publish(channel, number)}
        if moved:
            for channel, number in moved.items():
                self.records.mark(channel, number)
            self.records.event(OutsideTaken())

    def _run_stage(self, stage: int, members: list[HostEntry], time_us: int) -> Steps[None]:
        self._step = self._ledger.begin()
        self._stage = stage
        if self._lockstep:
            self._outstanding = {entry.index for entry in members if entry.expected}
        else:
            self._outstanding = {entry.index for entry in members if entry.state == "running" and not entry.busy}
        self.records.event(StageBegun(stage, self._place))
        self._broadcast(members, time_us)
        began_us = sent_us = self._began_us = self._events.now_us()
        first_us = self._patience[stage].wait_us
        repeat_us, look_us = first_us, began_us
        now_us = began_us
        while self._outstanding and not self._interrupted():
            if now_us >= look_us:
                self._look_after(members)
                if now_us > began_us:
                    self.on_wait()
                look_us = now_us + LOOK_US
            due_us = min(sent_us + repeat_us, look_us)
            if not self._lockstep:
                due_us = min(due_us, began_us + self._stage_time_us)
            yield from self._events.wait(due_us)
            now_us = self._events.now_us()
            if not self._outstanding:
                self._patience[stage].took(now_us - sent_us)
                self.times.stage_ended(stage, now_us - began_us)
                return
            if not self._lockstep and now_us >= began_us + self._stage_time_us:
                self._leave_behind(members, stage)
                self.times.stage_ended(stage, now_us - began_us)
                return
            if self._again or now_us >= sent_us + repeat_us:
                self.repeated += not self._again
                repeat_us = first_us if self._again else min(2 * repeat_us, max(first_us, REPEAT_LONGEST_US))
                self._again = False
                self._broadcast(members, time_us)
                sent_us = self._events.now_us()

    def _broadcast(self, members: list[HostEntry], time_us: int) -> None:
        holder = self.turns.holder
        self._telling.broadcast(self.tick, time_us, self._stage, self._place, holder, members, self._outstanding)

    def _look_after(self, members: list[HostEntry]) -> None:
        """Starts again who has to be, and does not wait for those who will not come back."""
        self._break_off(self._events.now_us())
        if self._hosts.unsettled:
            self._hosts.maintain()
            self._outstanding &= {entry.index for entry in members if entry.expected}

    def _see_off(self) -> Steps[None]:
        """Waits until those who leave have finalized: what they wrote then is visible in the tick that begins.

        Nobody waits for continuous ones.
        """
        continuous = self._continuous.hosts if self._continuous else set()
        while self._hosts.leaving - continuous and not self._interrupted():
            yield from self._events.wait(self._events.now_us() + LOOK_US)
            self._hosts.maintain()

    def _break_off(self, now_us: int) -> None:
        """Kills what shall stop but keeps the loop from reaching the boundary at which it would."""
        for index in self._outstanding:
            entry = self._hosts.table[index]
            if entry.leaves and now_us >= entry.asked_us + STUCK_US:
                entry.asked_us, entry.reason = now_us, "did not come out of its iteration; killed"
                self._log.warning(f"{entry.name}: shall stop, but {entry.reason}")
                self._hosts.kill(entry)

    def _on_recorded(self, recorded: recorded_t) -> None:
        self.records.taken = max(self.records.taken, recorded.tick)
        self.records.heard = max(self.records.heard, recorded.change)
        for channel, sequence in zip(recorded.channel, recorded.sequence, strict=True):
            self._came_in[channel] = max(sequence, self._came_in.get(channel, 0))

    def _on_done(self, done: done_t) -> None:
        if mistake := mistake_in(done, *self._sizes):
            raise MessageError(f"done of host {done.host}: {mistake}")
        entry = self._hosts.table[done.host]
        if done.kind == done_t.FINAL:
            self._on_final_done(entry, done)
            return
        if done.incarnation != entry.incarnation or not entry.alive:  # what the dead have sent is void already
            if done.incarnation == entry.incarnation and entry.state == "stopping":
                self._on_last_done(entry, done)
            return
        if entry.busy and entry.busy == _step_of(done):
            entry.busy = None
            self.times.on_time_again(entry, done.tick, done.busy_us)
        elif _step_of(done) == (self.tick, self._place) and done.host in self._outstanding:
            self._outstanding.discard(done.host)
            entry.seen = self._step
            self.times.answered(done.host, self._stage, done.busy_us, self.tick)
        elif not self._continuous or not self._continuous.take(entry, done):
            return
        if entry.changes:
            entry.told()
        self._take(done)

    def _on_last_done(self, entry: HostEntry, done: done_t) -> None:
        """Of one that leaves the loop: of the iteration that it was late with."""
        if entry.busy and entry.busy == _step_of(done):
            entry.busy = None
        elif not self._continuous or not self._continuous.take(entry, done):
            return
        self._take(done)

    def _on_final_done(self, entry: HostEntry, done: done_t) -> None:
        """Of what one that leaves wrote in finalize: taken once, and sent back as a sign that it was.

        One that was late has its last iteration taken first, if it ran it.
        """
        if done.incarnation != entry.incarnation or (entry.busy and entry.busy[0] <= done.tick):
            return
        self._sender.send(sync.TAKEN, sync.taken(done, taken_t.SUPERVISOR), self._ports.host(entry.index))
        if entry.state == "stopping" and entry.index in self._hosts.leaving:
            self._hosts.leaving.discard(entry.index)
            self._take(done)

    def _take(self, done: done_t) -> None:
        """What it says becomes visible with the next stage."""
        for channel, sequence in zip(done.channel, done.sequence, strict=True):
            self._ledger.publish(channel, sequence)
            self.records.mark(channel, sequence)
        if done.next_time_us >= 0:
            self.pace.source(done.next_time_us)
        self._missed.take(done)
        self.turns.ask(done)
        if self.opening:
            self.opening.ask(done)
        self.on_requests(done)
        if done.kind == done_t.FINAL:
            self.records.event(FinalDone(done.host, done.tick))
        elif done.kind == done_t.ITERATION:
            self.records.event(IterationDone(done.host, done.tick, done.iteration))
        else:
            self.records.event(StageDone(done.host, done.tick, done.step))

    def _leave_behind(self, members: list[HostEntry], stage: int) -> None:
        for entry in members:
            if entry.index in self._outstanding:
                entry.busy, entry.seen = (self.tick, self._place), self._step
                self._telling.owe(entry, members, stage)
                self.records.event(HostLate(entry.index))
                self.late += not entry.held
                self.times.late(entry, stage, self.tick, self._stage_time_us)
        self._outstanding = set()

    def _on_started(self, entry: HostEntry) -> None:
        self.records.event(HostStarted(entry.index, entry.incarnation, entry.started_with))
        if entry.incarnation > 1:
            self._log.info(f"{entry.name} runs again, start number {entry.incarnation}")
        self._again = True
        if self.opening:
            self.opening.came(entry)

    def _on_lost(self, entry: HostEntry) -> None:
        self.records.event(HostLost(entry.index))
        self._left(entry)
        if not self._lockstep or not entry.expected:
            self._outstanding.discard(entry.index)

    def _on_stopped(self, entry: HostEntry) -> None:
        self.records.event(HostStopped(entry.index))
        self._left(entry)

    def _left(self, entry: HostEntry) -> None:
        self.turns.left(entry.index)
        if self.opening:
            self.opening.left(entry)

    def _wait(self) -> Steps[None]:
        """Waits until it is time for the next tick, or none may begin."""
        now_us = self._events.now_us
        begin_us = self.pace.begin_us(now_us())
        yield from self._events.wait(0)
        while not self._interrupted() and not self.pace.stands and begin_us > now_us():
            yield from self._events.wait_on_time(begin_us)
            begin_us = self.pace.begin_us(now_us())


def _step_of(done: done_t) -> tuple[int, int] | None:
    """Tick and step that a done of a stage answers; None for other dones."""
    return (done.tick, done.step) if done.kind == done_t.STAGE else None

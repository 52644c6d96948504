"""The barrier at the end of each stage: lockstep waits for all hosts, real time goes on without late ones."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

from fwk.bus.network import Steps
from fwk.bus.retransmission import Backoff, RetransmissionTimeout
from fwk.engine.lookahead import lookahead
from fwk.model.plan import NOBODY
from fwk.model.tick_events import HostLate, StageBegun
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.loop_times import LoopTimes
from fwk.supervisor.processes.hosts import Hosts
from fwk.supervisor.tick_log import TickLog
from fwk.supervisor.tick_sender import Tick, TickSender, Turn
from fwk.supervisor.wait_report import WaitReport
from lcmtypes.core import done_t

NEVER_US = 1 << 62
REPEAT_LONGEST_US = 100_000
REPEAT_AHEAD_US = 5_000
"""Shortest wait before a tick is sent that all hosts of its stage run ahead: they take the time of several stages."""
LOOK_US = 20_000
"""Interval at which a waiting stage attends to hosts that are being restarted."""
STUCK_US = 1_000_000
"""Time for which a host that has to stop may keep the loop from its next boundary."""
WINDOW = 16
"""Ticks that the loop may be ahead of the gateway."""
REAL_TIME_WINDOW_US = 4_000_000
"""In real time as many ticks as take this long: the loop goes on while the gateway is stopped."""
ANNOUNCE_US = 20_000
"""Time for which a stopped gateway may delay real time when channels are opened."""


class Barrier(ABC):
    """Runs stages: sends the tick, waits for the dones, repeats ticks that may be lost."""

    window: int
    """Ticks that the loop may be ahead of the gateway."""
    announce_us = 0
    """Longest time for the gateway to listen to new channels; 0: as long as it takes."""

    def __init__(self, core: Core, hosts: Hosts, tick_log: TickLog, times: LoopTimes, report: WaitReport) -> None:
        self.repeated = 0
        """Ticks that had to be repeated."""
        self.late = 0
        """Iterations that were not done within the time of their stage."""
        self.outstanding: set[int] = set()
        """Hosts that have not answered the running stage."""
        self.turn = Turn(-1, -1, [])
        """The newest stage."""
        self.place = (0, -1)
        """Tick and step of the newest stage."""
        self.ledger_step = 0
        """Step of the ledger at which it began."""
        self.sender = TickSender(core)
        self.report = report
        self._core = core
        self._hosts = hosts
        self._tick_log = tick_log
        self._times = times
        self._timeouts = [RetransmissionTimeout() for _ in core.plan.stages]
        self._tick = Tick(0, 0, -1)
        self._lookahead = lookahead(core.plan)
        self._early: dict[tuple[int, int], dict[int, done_t]] = {}  # by tick and step, then by host
        self._rejoined = False  # a host joined the running stage: send it the tick at once
        self._repeated = -1, (0, -1)  # the newest stage whose tick was repeated, and its place

    def run(self, tick: Tick, turn: Turn) -> Steps[None]:
        """Runs one stage of a tick to its end."""
        core, stage = self._core, turn.stage
        self._tick, self.turn, self.place = tick, turn, (tick.number, turn.step)
        self.ledger_step = core.ledger.begin()
        self.outstanding = self._participants(turn.hosts)
        self._tick_log.event(StageBegun(stage, turn.step))
        self._send(begins=True)
        began_us = sent_us = now_us = core.now_us()
        timeout = self._timeouts[stage]
        self._take_early()
        look_us = began_us + LOOK_US
        ends_us = self._ends_us(began_us)
        repeats = self._repeats(sent_us)
        while self.outstanding and not core.interrupted():
            if now_us >= look_us:
                self._look_after(began_us)
                look_us = now_us + LOOK_US
            yield from core.events.wait(min(repeats.due_us, look_us, ends_us))
            now_us = core.now_us()
            if not self.outstanding:
                timeout.took(now_us - sent_us, repeated=self._repeated[1] == self.place)
            elif now_us >= ends_us:
                self._leave_behind()
            elif self._rejoined:
                self._rejoined = False
                self._send()
                sent_us = core.now_us()
                repeats = self._repeats(sent_us)
            elif now_us >= repeats.due_us:
                self.repeated += 1
                self._repeated = stage, self.place
                timeout.repeated()
                self._send()
                sent_us = core.now_us()
                repeats.repeated(sent_us)
        self.report.ended()
        self._times.stage_ended(stage, now_us - began_us)

    def _repeats(self, now_us: int) -> Backoff:
        """Returns when a tick of the running stage that was sent now is repeated."""
        first_us = self._timeouts[self.turn.stage].wait_us
        if all(self._runs_ahead(host) for host in self.turn.hosts if host.index in self.outstanding):
            first_us = max(first_us, REPEAT_AHEAD_US)
        return Backoff(now_us, first_us, max(first_us, REPEAT_LONGEST_US))

    def answered(self, host: HostProcess) -> None:
        """Notes that a host has answered the running stage."""
        self.outstanding.discard(host.index)
        host.answered_step = host.told_step

    def keep_early(self, host: HostProcess, done: done_t) -> None:
        """Keeps the done of a stage that has not begun yet, if the host may run that stage ahead."""
        place = done.tick, done.step
        if self.place < place <= host.ahead and done.kind == done_t.STAGE and done.incarnation == host.incarnation:
            kept = self._early.setdefault(place, {})
            host.early += host.index not in kept
            kept[host.index] = done

    def answered_again(self, done: done_t) -> None:
        """Notes a done that does not count: perhaps a host answers a repeated tick that it had answered before."""
        stage, place = self._repeated
        if (done.tick, done.step) == place:
            self._timeouts[stage].answered_twice()

    def _take_early(self) -> None:
        """Takes the dones of hosts that have run the beginning stage ahead, also of those that have died since."""
        for index, done in self._early.pop(self.place, {}).items():
            host = self._core.hosts[index]
            host.early -= host.early > 0  # its end may have been taken already
            self._core.events.emit(done)
        self._core.events.dispatch()
        self._hosts.take_ends()

    def _runs_ahead(self, host: HostProcess) -> bool:
        """Returns whether a host runs the stage on the marks of an earlier one, without a tick."""
        return host.told_step < self.ledger_step and host.ahead >= self.place

    def _send(self, begins: bool = False) -> None:
        """Sends the tick to all outstanding hosts; when the stage begins, not to those that run it ahead."""
        tick, turn, outstanding = self._tick, self.turn, self.outstanding
        if begins:
            ahead = {host.index for host in turn.hosts if self._runs_ahead(host)}
            outstanding = outstanding - ahead if ahead else outstanding
        for host in turn.hosts:
            if host.ahead < self.place and host.running and host.index in outstanding:
                last = self._lookahead[host.index][turn.stage] if tick.main_loop == NOBODY else turn.step
                host.told_step, host.ahead = self.ledger_step, (tick.number, last)
        self.sender.broadcast(tick, turn, outstanding)

    def joined(self) -> None:
        """Notes that a host is ready: it may belong to the running stage."""
        self._rejoined = True

    @abstractmethod
    def lost(self, host: HostProcess) -> None:
        """Notes that the process of a host ended."""

    @abstractmethod
    def _participants(self, hosts: Sequence[HostProcess]) -> set[int]:
        """Returns the hosts that a stage waits for."""

    @abstractmethod
    def _ends_us(self, began_us: int) -> int:
        """Returns the latest wall time at which a stage ends."""

    def _leave_behind(self) -> None:
        """Ends the stage without the hosts that have not answered."""
        turn = self.turn
        for host in turn.hosts:
            if host.index in self.outstanding:
                host.late_with, host.answered_step = self.place, self.ledger_step
                self.sender.keep_for(host, turn)
                self._tick_log.event(HostLate(host.index))
                self.late += not host.held
                self._times.late(host, turn.stage, self._tick.number, self._ends_us(0))
        self.outstanding = set()

    def _look_after(self, began_us: int) -> None:
        """Restarts hosts that crashed, and gives up those that do not come back."""
        now_us = self._core.now_us()
        for index in sorted(self.outstanding):
            host = self._core.hosts[index]
            if host.must_leave and now_us >= host.asked_us + STUCK_US:
                self._break_off(host, now_us)
        if now_us >= began_us + STUCK_US:  # perhaps a host lacks a message of one that died
            self._hosts.take_ends(also_early=True)
        if self._hosts.unsettled:
            self._hosts.enforce_timeouts()
            self._hosts.start_due()
            self.outstanding &= {host.index for host in self.turn.hosts if host.expected}
        waited_for = [host for host in self.turn.hosts if host.index in self.outstanding]
        self.report.waiting(began_us, waited_for, f"tick {self._tick.number}")

    def _break_off(self, host: HostProcess, now_us: int) -> None:
        """Kills a host that has to stop but keeps the loop from reaching the boundary for that."""
        host.asked_us, host.reason = now_us, "did not come out of its iteration; killed"
        self._core.log.warning(f"{host.name}: shall stop, but {host.reason}")
        self._hosts.kill(host)


class Lockstep(Barrier):
    """A stage ends when all hosts have answered, including those that are being restarted."""

    window = WINDOW

    def lost(self, host: HostProcess) -> None:
        """Continues to wait for a host that is restarted."""
        if not host.expected:
            self.outstanding.discard(host.index)

    def _participants(self, hosts: Sequence[HostProcess]) -> set[int]:
        return {host.index for host in hosts if host.expected}

    def _ends_us(self, began_us: int) -> int:
        return began_us + NEVER_US


class RealTime(Barrier):
    """A stage ends when all running hosts have answered, or when its time is up; late hosts are absent until they
    answer.
    """

    announce_us = ANNOUNCE_US

    def __init__(self, core: Core, hosts: Hosts, tick_log: TickLog, times: LoopTimes, report: WaitReport) -> None:
        super().__init__(core, hosts, tick_log, times, report)
        self.window = max(WINDOW, REAL_TIME_WINDOW_US // core.plan.period_us)
        self._stage_time_us = core.plan.stage_time_us or core.plan.period_us

    def lost(self, host: HostProcess) -> None:
        """Continues without a host that ended."""
        self.outstanding.discard(host.index)

    def _participants(self, hosts: Sequence[HostProcess]) -> set[int]:
        return {host.index for host in hosts if host.running and not host.late_with}

    def _ends_us(self, began_us: int) -> int:
        return began_us + self._stage_time_us


def barrier_of(core: Core, hosts: Hosts, tick_log: TickLog, times: LoopTimes, report: WaitReport) -> Barrier:
    """Makes the barrier for the plan's clock."""
    kind = Lockstep if core.lockstep else RealTime
    return kind(core, hosts, tick_log, times, report)

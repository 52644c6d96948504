"""The host processes of a run: starts them, hears of their states and ends, starts them again as their policy says."""

import signal
from collections.abc import Callable
from functools import partial

from fwk.bus.network import Steps
from fwk.clock import US_PER_S, Clock
from fwk.component.log import Logger
from fwk.engine.assignment import Start
from fwk.engine.visibility import Ledger
from fwk.host.debugger import LEFT
from fwk.model.plan import NOBODY, Plan
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.options import RunBroken
from fwk.supervisor.processes.external_process import Hand
from fwk.supervisor.processes.fetch_forwarder import StandIn
from fwk.supervisor.processes.host_process import HostEntry, host_table
from fwk.supervisor.processes.output import Printed
from fwk.supervisor.processes.starter import ProcessStarter, Started
from fwk.supervisor.sync_receiver import SyncReceiver
from lcmtypes.core import actual_t

STOP_GRACE_US = 3 * US_PER_S
LOOK_US = 100_000  # how often to look after hosts that are being started
WAITS_US = US_PER_S // 2  # who waits longer for another is told


class StartFailure(Exception):  # noqa: N818 - what happened to the run
    """Components did not become ready; names each with its reason."""


class Hosts:
    """All host processes, by index.

    A process is started when those that it needs run. One that they will not come back for fails.
    """

    def __init__(
        self,
        plan: Plan,
        starter: ProcessStarter,
        ledger: Ledger,
        events: EventLoop,
        receiver: SyncReceiver,
        log: Logger,
        clock: Clock,
    ) -> None:
        self.table: list[HostEntry] = host_table(plan)
        self.on_started: Callable[[HostEntry], None] = lambda _: None
        self.on_lost: Callable[[HostEntry], None] = lambda _: None
        self.on_stopped: Callable[[HostEntry], None] = lambda _: None
        self.asked: set[int] = set()
        """Hosts whose desired state was changed and that do not have it yet."""
        self.leaving: set[int] = set()
        """Hosts that were asked to stop and have not finalized yet."""
        self.settings_of: Callable[[HostEntry], dict[str, str]] = lambda _: {}
        self.blackboard: Callable[[], str] = lambda: "[]"
        """What is open that was opened at run time."""
        self._plan = plan
        self._starter = starter
        self._ledger = ledger
        self._events = events
        self._receiver = receiver
        self._now_us = events.now_us
        self._log = log
        self._clock = clock
        self._stopping = False
        self._told: set[int] = set()  # hosts that were said to wait for others
        self._standins: dict[int, StandIn] = {}
        self._hands: dict[int, Hand] = {}
        self.printed = Printed(events, log, plan.log.lines_per_s)
        receiver.on_actual = self._on_actual
        events.watch(starter, self._on_process_events)

    def start_all(self, interrupted: Callable[[], bool]) -> Steps[None]:
        """Starts every host and waits until all are ready.

        Raises:
            StartFailure: some are not, with the reasons.
        """
        now_us = self._now_us()
        for entry in self.table:
            entry.since_us = now_us
        self._start_ready("loaded")
        while any(entry.state == "starting" for entry in self.table) and not interrupted():
            yield from self._events.wait(now_us + LOOK_US)
            now_us = self._now_us()
            for entry in self.table:
                if entry.overdue(now_us):
                    entry.state, entry.reason = "failed", _not_ready(entry)
            self._start_ready("loaded")
        failed = [entry for entry in self.table if entry.state in ("failed", "waiting")]
        if failed:
            failed += [entry for entry in self.table if entry.state == "loaded"]
            raise StartFailure("\n".join(f"{entry.name}: {entry.reason}" for entry in failed))

    def maintain(self) -> None:
        """Starts hosts again whose time has come; gives up on those that do not become ready."""
        now_us = self._now_us()
        for entry in self.table:
            if entry.overdue(now_us):
                entry.since_us, entry.reason = now_us, _not_ready(entry)
                self._log.error(f"{entry.name}: {entry.reason}; killed")
                self.kill(entry)
            elif entry.state == "stopping" and now_us - entry.since_us > STOP_GRACE_US:
                entry.since_us, entry.reason = now_us, "did not stop when asked; killed"
                self._log.warning(f"{entry.name}: {entry.reason}")
                self.kill(entry)
        self._start_ready("waiting")

    def steer(self) -> None:
        """Between two ticks: what is asked to leave the loop leaves it, what is asked to join it is started."""
        if not self.asked:
            return
        for entry in [entry for entry in self.table if entry.index in self.asked]:
            if entry.settled:
                self.asked.discard(entry.index)
            elif entry.leaves:
                entry.leaving(self._now_us())
                self.leaving.add(entry.index)
                self.on_stopped(entry)
                self._signal(entry, signal.SIGTERM)
            elif entry.joins:
                if entry.state != "waiting" or entry.restart_us > self._now_us():
                    entry.waits(self._now_us())
            elif not entry.wanted and entry.state in ("loaded", "waiting", "failed"):
                entry.state, entry.reason = "stopped", ""
                self.on_stopped(entry)
        self._start_ready("waiting")

    def kill(self, entry: HostEntry) -> None:
        """Ends a process that cannot be asked any more."""
        self._signal(entry, signal.SIGKILL)

    def by_hand(self, entry: HostEntry) -> int:
        """The process started by hand that has a host's place or waits for it; 0: none."""
        return self._hands[entry.index].pid if entry.index in self._hands else 0

    def hand_over(self, entry: HostEntry, hand: Hand) -> None:
        """At the next boundary a process started by hand takes the place; when it has ended, the host comes back."""
        self._hands[entry.index] = hand
        hand.watch(partial(self._on_hand_ended, entry, hand))
        entry.want_restart(self._now_us())
        self.asked.add(entry.index)

    @property
    def unsettled(self) -> bool:
        """Whether something has to be maintained."""
        return any(entry.state in ("waiting", "starting", "stopping") for entry in self.table)

    def failed_components(self) -> dict[str, str]:
        """Names of components that have failed, and why."""
        components = (component for entry in self.table for component in entry.components)
        return {component.name: component.reason for component in components if component.state == "failed"}

    def stop_all(self) -> Steps[list[str]]:
        """Asks all hosts to stop, also those that stand still; kills those that do not and returns their names."""
        self._stopping = True
        killed = []
        self._starter.wake()
        for entry in self.table:
            if entry.alive and entry.pid:
                self._signal(entry, signal.SIGTERM)
                self._signal(entry, signal.SIGCONT)  # somebody may have stopped it
            elif entry.state == "waiting":
                entry.state = "failed"
        deadline_us = self._now_us() + STOP_GRACE_US
        while any(entry.pid for entry in self.table) and self._now_us() < deadline_us:
            yield from self._events.wait(deadline_us)
        for entry in self.table:
            if entry.pid:
                killed.append(entry.name)
                self._signal(entry, signal.SIGKILL)
        deadline_us = self._now_us() + STOP_GRACE_US
        while any(entry.pid for entry in self.table) and self._now_us() < deadline_us:
            yield from self._events.wait(deadline_us)
        return killed

    def _start_ready(self, state: str) -> None:
        """Starts those in this state whose time has come and whose needs run; says for whom the others wait."""
        now_us = self._now_us()
        for entry in self.table:
            if entry.state != state or now_us < entry.restart_us or self._stopping:
                continue
            missing = [each for index in entry.needs if (each := self.table[index]).state != "running"]
            lost = [each for each in missing if each.state == "failed" or not each.wanted]
            if not missing:
                self._start(entry)
            elif lost and state == "waiting":
                ends = [
                    f"{each.name}, which {'has failed' if each.state == 'failed' else 'is stopped'}" for each in lost
                ]
                entry.give_up(f"needs {', '.join(ends)}")
                self._stand_in(entry)
                self._log.error(f"{entry.name}: not started: it {entry.reason}")
            else:
                entry.reason = f"waits for {', '.join(each.name for each in missing)}"
                if entry.index not in self._told and now_us > entry.since_us + WAITS_US:
                    self._told.add(entry.index)
                    self._log.info(f"{entry.name} {entry.reason}")

    def _start(self, entry: HostEntry) -> None:
        standin = self._standins.pop(entry.index, None)
        if standin:
            standin.close()
        self._told.discard(entry.index)
        incarnation = entry.starting(self._now_us())
        settings, sequences = self.settings_of(entry), self._ledger.sequences(entry.index)
        start = Start(
            incarnation,
            sequences,
            settings,
            self.blackboard(),
            entry.started_with,
            self._clock.tick,
            self._clock.now_us,
        )
        hand = self._hands.get(entry.index)
        if hand:
            entry.pid, entry.held = hand.pid, hand.held
            hand.begin(start)
        else:
            entry.held = incarnation == 1 and self._starter.debugs(entry.index)
            self._starter.start(entry.index, start, entry.fresh_code)

    def _signal(self, entry: HostEntry, number: int) -> None:
        hand = self._hands.get(entry.index)
        if hand and hand.pid == entry.pid:
            hand.signal(number)
        elif entry.pid:
            self._starter.signal(entry.pid, number)

    def _on_hand_ended(self, entry: HostEntry, hand: Hand) -> None:
        del self._hands[entry.index]
        hand.close()
        if entry.pid == hand.pid:
            self._ended(entry, 0 if self._stopping else LEFT)

    def _on_actual(self, actual: actual_t) -> None:
        if actual.host >= len(self.table):
            return
        entry = self.table[actual.host]
        if actual.incarnation != entry.incarnation:
            return
        entry.heard(actual.components, actual.times)
        failed = [item.reason for item in actual.components if item.state == "failed"]
        if failed:
            entry.reason = failed[0]
        elif entry.state == "starting" and all(item.state == "running" for item in actual.components):
            entry.state, entry.since_us = "running", self._now_us()
            self.on_started(entry)

    def _on_process_events(self) -> None:
        try:
            events = self._starter.events()
        except RunBroken:
            self._events.unwatch(self._starter)
            for entry in self.table:
                entry.pid = 0  # the kernel kills them all
            raise
        for event in events:
            entry = self.table[event.host]
            if isinstance(event, Started):
                entry.pid = event.pid
                if entry.state == "stopping":  # asked to stop before there was a process to ask
                    self._signal(entry, signal.SIGTERM)
                if event.streams:
                    self.printed.listen(entry.name, *event.streams)
            elif event.incarnation == entry.incarnation:
                self._ended(entry, event.code, event.core)

    def _ended(self, entry: HostEntry, code: int, core: bool = False) -> None:
        asked = entry.state == "stopping"
        if asked:
            self._receiver.drain()  # its last done came before its end
        self.leaving.discard(entry.index)
        culprit = self._culprit(entry)
        entry.ended(code, self._now_us(), self._stopping, core, culprit)
        self._ledger.void(entry.index, entry.incarnation + 1, self._clock.tick)
        if not asked:
            self.on_lost(entry)
        if not entry.expected and not self._stopping:
            self._stand_in(entry)
        if not self._stopping and not asked:
            again = f"; starting it again in {max(0, entry.restart_us - self._now_us()) / US_PER_S:.1f} s"
            log = self._log.info if code == LEFT else self._log.error
            others = [name for name in self._members(entry) if name != culprit]
            went = f"; with it went {', '.join(others)}" if len(others) + bool(culprit) > 1 else ""
            log(f"{entry.name} ended: {entry.reason}{went}{again if entry.state == 'waiting' else ''}")

    def _members(self, entry: HostEntry) -> list[str]:
        return [self._plan.components[index].name for index in self._plan.hosts[entry.index].components]

    def _culprit(self, entry: HostEntry) -> str:
        """Which component of a shared process was to blame for its end; empty if nobody knows."""
        if len(self._members(entry)) < 2:
            return ""
        failed = [item.name for item in entry.components if item.state == "failed"]
        working = self._starter.component_at(entry.index)
        return failed[0] if failed else self._plan.components[working].name if working != NOBODY else ""

    def _stand_in(self, entry: HostEntry) -> None:
        if entry.index not in self._standins:
            self._standins[entry.index] = StandIn(self._plan, entry.index, self._events)


def _not_ready(entry: HostEntry) -> str:
    stuck = [item.name for item in entry.components if item.state == "init"]
    where = f"; still in init: {', '.join(stuck)}" if stuck else ""
    return f"not ready after {entry.ready_timeout_us / US_PER_S:g} s{where}"

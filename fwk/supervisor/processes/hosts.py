"""The host processes of a run: starts them, follows their states and ends, restarts them by their policies."""

import signal

from fwk.bus.network import Steps
from fwk.clock import US_PER_S
from fwk.engine.assignment import Start
from fwk.host.debugger import LEFT
from fwk.model.plan import NOBODY
from fwk.supervisor.changes import Changes
from fwk.supervisor.channel_requests import ChannelRequests
from fwk.supervisor.core import Core
from fwk.supervisor.host_events import HostEnded, HostLeaves, HostReady
from fwk.supervisor.host_process import HostProcess, HostState
from fwk.supervisor.options import RunBrokenError
from fwk.supervisor.processes.external_process import ExternalProcess
from fwk.supervisor.processes.fetch_forwarder import FetchForwarder
from fwk.supervisor.processes.output import CapturedOutput
from fwk.supervisor.processes.starter import Ended, ProcessStarter, Started
from fwk.supervisor.sync_receiver import SyncReceiver
from fwk.supervisor.wait_report import WaitReport
from lcmtypes.core import actual_t

STOP_GRACE_US = 3 * US_PER_S
"""Time that hosts have to end when the whole run ends."""
LOOK_US = 100_000
NAMED_AFTER_US = US_PER_S // 2
"""Wait for needed hosts after which a host is named."""


class StartFailedError(Exception):
    """Components did not become ready; names each with its reason."""


class Hosts:
    """Starts, signals and ends the host processes of a run."""

    def __init__(
        self,
        core: Core,
        starter: ProcessStarter,
        receiver: SyncReceiver,
        changes: Changes,
        channels: ChannelRequests,
    ) -> None:
        self.output = CapturedOutput(core.events, core.log, core.plan.log.lines_per_s)
        self._core = core
        self._log = core.log
        self._starter = starter
        self._receiver = receiver
        self._changes = changes
        self._channels = channels
        self._stopping = False
        self._started = False
        self._asked: set[int] = set()  # hosts whose desired state was changed and that do not have it yet
        self._named: set[int] = set()  # hosts that were said to wait for others
        self._forwarders: dict[int, FetchForwarder] = {}
        self._early_ends: list[Ended] = []  # of hosts whose dones of later stages have come
        self._external: dict[int, ExternalProcess] = {}
        core.events.watch(starter, self._read_starter)
        core.events.subscribe(actual_t, self._take_state)
        core.events.subscribe(Started, self._take_start)
        core.events.subscribe(Ended, self._take_end)

    def start_all(self, report: WaitReport) -> Steps[None]:
        """Starts every host and waits until all are ready.

        Raises:
            StartFailedError: some are not, with the reasons.
        """
        core = self._core
        began_us = core.now_us()
        for host in core.hosts:
            host.since_us = began_us
        self._start_due(HostState.LOADED)
        while (
            starting := [host for host in core.hosts if host.state is HostState.STARTING]
        ) and not core.interrupted():
            report.waiting(began_us, starting, "the start of the run")
            yield from core.events.wait(core.now_us() + LOOK_US)
            now_us = core.now_us()
            for host in core.hosts:
                if host.not_ready_in_time(now_us):
                    host.fail(_not_ready(host))
            self._start_due(HostState.LOADED)
        report.ended()
        failed = [host for host in core.hosts if host.failed or host.state is HostState.WAITING]
        if failed:
            failed += [host for host in core.hosts if host.state is HostState.LOADED]
            raise StartFailedError("\n".join(f"{host.name}: {host.reason}" for host in failed))
        self._started = True

    @property
    def unsettled(self) -> bool:
        """Whether time alone may change the state of a host."""
        return any(host.unsettled for host in self._core.hosts)

    def request(self, host: HostProcess) -> None:
        """Notes that the desired state of a host was changed; the next boundary realises it."""
        self._asked.add(host.index)

    def enforce_timeouts(self) -> None:
        """Kills processes that did not become ready, or did not end, within their time."""
        now_us = self._core.now_us()
        for host in self._core.hosts:
            if host.not_ready_in_time(now_us):
                host.since_us, host.reason = now_us, _not_ready(host)
                self._log.error(f"{host.name}: {host.reason}; killed")
                self.kill(host)
            elif host.not_stopped_in_time(now_us):
                host.since_us, host.reason = now_us, "did not stop when asked; killed"
                self._log.warning(f"{host.name}: {host.reason}")
                self.kill(host)

    def retire(self) -> None:
        """At a boundary, takes hosts that have to stop out of the loop and asks their processes to end."""
        now_us = self._core.now_us()
        for host in [self._core.hosts[index] for index in sorted(self._asked)]:
            if host.settled:
                self._asked.discard(host.index)
            elif host.must_leave:
                host.begin_stop(now_us)
                self._core.events.emit(HostLeaves(host))
                self._signal(host, signal.SIGTERM)
            elif not host.wanted and host.state in (HostState.LOADED, HostState.WAITING, HostState.FAILED):
                host.stay_stopped()
                self._core.events.emit(HostLeaves(host))

    def admit(self) -> None:
        """At a boundary, lets hosts that have to join the loop start as soon as their needs run."""
        now_us = self._core.now_us()
        for host in [self._core.hosts[index] for index in sorted(self._asked)]:
            if host.must_join and (host.state is not HostState.WAITING or host.restart_us > now_us):
                host.wait_for_start(now_us)

    def start_due(self) -> None:
        """Starts waiting hosts whose time has come and whose needs run."""
        self._start_due(HostState.WAITING)

    def kill(self, host: HostProcess) -> None:
        """Kills a process that does not respond."""
        self._signal(host, signal.SIGKILL)

    def external_process(self, host: HostProcess) -> int:
        """Returns the number of the external process that has a host's place or waits for it; 0: none."""
        return self._external[host.index].pid if host.index in self._external else 0

    def hand_over(self, host: HostProcess, process: ExternalProcess) -> None:
        """Gives a host's place to an external process at the next boundary; the host comes back when that ends."""
        self._external[host.index] = process
        process.watch(lambda: self._take_external_end(host, process))
        host.want_restart(self._core.now_us())
        self.request(host)

    def component_at_work(self, host: HostProcess) -> str:
        """Returns the name of the component that a host executes; if none, the name of the host."""
        working = self._starter.component_at(host.index)
        return self._core.plan.components[working].name if working != NOBODY else host.name

    def failed_components(self) -> dict[str, str]:
        """Returns the names of components that have failed, with the reasons."""
        components = (component for host in self._core.hosts for component in host.components)
        return {component.name: component.reason for component in components if component.state == "failed"}

    def stop_all(self) -> Steps[list[str]]:
        """Asks all hosts to stop, also stopped processes; kills those that do not end and returns their names."""
        self._stopping = True
        killed = []
        self._starter.wake()
        for host in self._core.hosts:
            if host.pid and host.state is not HostState.STOPPING:
                self._signal(host, signal.SIGTERM)
            if host.pid:
                self._signal(host, signal.SIGCONT)
            elif host.state is HostState.WAITING:
                host.fail(host.reason)
        yield from self._until_ended()
        for host in self._core.hosts:
            if host.pid:
                killed.append(host.name)
                self._signal(host, signal.SIGKILL)
        yield from self._until_ended()
        return killed

    def _until_ended(self) -> Steps[None]:
        deadline_us = self._core.now_us() + STOP_GRACE_US
        while any(host.pid for host in self._core.hosts) and self._core.now_us() < deadline_us:
            yield from self._core.events.wait(deadline_us)

    def _start_due(self, state: HostState) -> None:
        """Starts hosts in a state whose time has come and whose needs run; names those that wait for others."""
        now_us = self._core.now_us()
        for host in self._core.hosts:
            if host.state is not state or now_us < host.restart_us or self._stopping or not host.wanted:
                continue
            missing = [needed for index in host.needs if not (needed := self._core.hosts[index]).running]
            lost = [needed for needed in missing if needed.failed or not needed.wanted]
            if not missing:
                self._start(host)
            elif lost and state is HostState.WAITING:
                ends = [f"{each.name}, which {'has failed' if each.failed else 'is stopped'}" for each in lost]
                host.fail(f"needs {', '.join(ends)}")
                self._forward_fetches(host)
                self._log.error(f"{host.name}: not started: it {host.reason}")
            else:
                host.reason = f"waits for {', '.join(each.name for each in missing)}"
                if now_us > host.since_us + NAMED_AFTER_US and host.index not in self._named:
                    self._named.add(host.index)
                    self._log.info(f"{host.name} {host.reason}")

    def _start(self, host: HostProcess) -> None:
        if host.index in self._forwarders:
            self._forwarders.pop(host.index).close()
        self._named.discard(host.index)
        incarnation = host.begin_start(self._core.now_us())
        clock = self._core.clock.clock
        sequences = self._core.ledger.sequences(host.index)
        host.started_with = self._changes.newest
        start = Start(
            incarnation,
            sequences,
            self._changes.settings_of(host),
            self._channels.snapshot(),
            self._changes.newest,
            clock.tick,
            clock.now_us,
        )
        external = self._external.get(host.index)
        if external:
            host.pid, host.held = external.pid, external.held
            external.begin(start)
        else:
            host.held = incarnation == 1 and self._starter.debugs(host.index)
            self._starter.start(host.index, start, host.fresh_code)

    def _signal(self, host: HostProcess, number: int) -> None:
        external = self._external.get(host.index)
        if external and external.pid == host.pid:
            external.signal(number)
        elif host.pid:
            self._starter.signal(host.pid, number)

    def _read_starter(self) -> None:
        try:
            found = self._starter.events()
        except RunBrokenError:
            self._core.events.unwatch(self._starter)
            for host in self._core.hosts:
                host.pid = 0  # the kernel kills them all
            raise
        self._receiver.drain()  # the last done of a process came before its end
        for event in found:
            self._core.events.emit(event)

    def _take_state(self, actual: actual_t) -> None:
        host = self._core.hosts[actual.host]
        if actual.incarnation != host.incarnation:
            return
        host.report(actual.components, actual.times, actual.counters)
        failed = [item.reason for item in actual.components if item.state == "failed"]
        if failed:
            host.reason = failed[0]
        elif host.state is HostState.STARTING and all(item.state == "running" for item in actual.components):
            host.become_ready(self._core.now_us())
            self._core.events.emit(HostReady(host))

    def _take_start(self, event: Started) -> None:
        host = self._core.hosts[event.host]
        host.pid = event.pid
        if host.state is HostState.STOPPING or self._stopping:  # asked to stop before there was a process
            self._signal(host, signal.SIGTERM)
        if event.streams:
            self.output.listen(host.name, *event.streams)

    def _take_end(self, event: Ended) -> None:
        host = self._core.hosts[event.host]
        if event.incarnation != host.incarnation:
            return
        if host.early and not self._stopping:  # it died in a later stage than the running one
            self._early_ends.append(event)
        else:
            self._end(host, event.code, event.core)

    def take_ends(self, also_early: bool = False) -> None:
        """Takes the ends of processes that had run stages ahead, once these stages have begun."""
        if not self._early_ends:
            return
        ends, self._early_ends = self._early_ends, []
        for event in ends:
            if also_early:
                self._core.hosts[event.host].early = 0
            self._core.events.emit(event)
        self._core.events.dispatch()

    def _take_external_end(self, host: HostProcess, process: ExternalProcess) -> None:
        del self._external[host.index]
        process.close()
        if host.pid == process.pid:
            self._end(host, 0 if self._stopping else LEFT)

    def _end(self, host: HostProcess, code: int, core: bool = False) -> None:
        asked = host.state is HostState.STOPPING
        culprit = self._culprit(host)
        host.ended(code, self._core.now_us(), self._stopping, core, culprit)
        self._core.ledger.void(host.index, host.incarnation + 1, self._core.clock.tick)
        if not asked:
            self._core.events.emit(HostEnded(host))
        if not self._stopping:  # its next process may be far off: the loop may wait for the gateway before it starts
            self._forward_fetches(host)
        if not self._stopping and not asked:
            self._log_end(host, code, culprit)

    def _log_end(self, host: HostProcess, code: int, culprit: str) -> None:
        again = ""
        if host.state is HostState.WAITING and self._started:  # a failure before the start ends the run
            wait_us = max(0, host.restart_us - self._core.now_us())
            again = f"; restart in {wait_us / US_PER_S:.1f} s"
        log = self._log.info if code == LEFT else self._log.error
        others = [name for name in self._component_names(host) if name != culprit]
        went = f"; its process also held {', '.join(others)}" if len(others) + bool(culprit) > 1 else ""
        log(f"{host.name} ended: {host.reason}{went}{again}")

    def _component_names(self, host: HostProcess) -> list[str]:
        return [self._core.plan.components[index].name for index in self._core.components_of(host)]

    def _culprit(self, host: HostProcess) -> str:
        """Returns the component of a shared process that caused its end; empty if that is unknown."""
        if len(self._core.components_of(host)) < 2:
            return ""
        failed = [item.name for item in host.components if item.state == "failed"]
        working = self._starter.component_at(host.index)
        return failed[0] if failed else self._core.plan.components[working].name if working != NOBODY else ""

    def _forward_fetches(self, host: HostProcess) -> None:
        if host.index not in self._forwarders:
            self._forwarders[host.index] = FetchForwarder(self._core, host.index)


def _not_ready(host: HostProcess) -> str:
    stuck = [item.name for item in host.components if item.state == "init"]
    where = f"; still in init: {', '.join(stuck)}" if stuck else ""
    return f"not ready after {(host.ready_timeout_us or 0) / US_PER_S:g} s{where}"

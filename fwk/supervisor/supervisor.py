"""The supervisor as a participant: owns plan, clock, marks and main loop, and starts and ends every host of the run."""

import signal
import socket
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from fwk.bus.network import Network, Steps
from fwk.bus.receiver import Complaints
from fwk.bus.sender import Sender
from fwk.clock import US_PER_S
from fwk.component.images import Ring
from fwk.component.log import Logger
from fwk.engine.boundary import BoundaryRequests
from fwk.engine.schedule import Schedule
from fwk.engine.visibility import Visibility
from fwk.host.debugger import DebugRequest
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.supervisor.barrier import barrier_of
from fwk.supervisor.boundary import Boundary
from fwk.supervisor.changes import Changes
from fwk.supervisor.channel_requests import ChannelRequests
from fwk.supervisor.continuous import ContinuousHosts
from fwk.supervisor.control.control import Control, Listen
from fwk.supervisor.control.status import StatusReport
from fwk.supervisor.core import Core
from fwk.supervisor.dones import Dones
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.host_process import host_processes
from fwk.supervisor.lifecycle import Lifecycle
from fwk.supervisor.loop import Loop
from fwk.supervisor.loop_times import LoopTimes
from fwk.supervisor.options import RunBrokenError, RunOptions
from fwk.supervisor.processes.attach import Attach
from fwk.supervisor.processes.hosts import Hosts, StartFailedError
from fwk.supervisor.processes.starter import ProcessStarter
from fwk.supervisor.run_clock import RunClock
from fwk.supervisor.sync_receiver import SyncReceiver
from fwk.supervisor.tick_log import TickLog
from fwk.supervisor.wait_report import WaitReport
from lcmtypes.core import status_t

INTERRUPTED = "interrupted"
"""Reason for the end of a run that a signal has ended."""


class GatewayProcess(Protocol):
    """The gateway as the supervisor sees it."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when the gateway has ended."""
        ...

    def gateway_end(self) -> str:
        """Describes how the gateway process ended."""
        ...


class Signals(Protocol):
    """Signals that ask the run to end."""

    received: list[int]

    def fileno(self) -> int:
        """Returns the descriptor that is readable when a signal came."""
        ...

    def handle(self) -> None:
        """Clears the descriptor."""
        ...


@dataclass(frozen=True)
class Machine:
    """Parts of the machine that a supervisor uses besides the run's buses; missing ones do not exist."""

    starter: ProcessStarter
    signals: Signals | None = None
    listen: Listen | None = None
    """Opens the control server."""
    rings: Mapping[str, Ring] = field(default_factory=dict)
    """Descriptors of the rings with the frames of cameras."""
    host_sockets: Mapping[int, socket.socket] = field(default_factory=dict)
    """The hosts' own sockets, by port."""
    debug: DebugRequest | None = None


class Supervisor:
    """One run of a plan, from the first process to the last."""

    def __init__(self, plan: Plan, options: RunOptions, number: int, network: Network, machine: Machine) -> None:
        self._options = options
        ports = Ports.of(plan)
        sender = Sender(ports.supervisor, network)
        clock = RunClock(plan, options.speed)
        self.log = Logger("supervisor", clock.clock, lambda line: sender.publish(b"fwk/log", line.encode(), ports.log))
        events, table = EventLoop(network), host_processes(plan)
        self._core = core = Core(
            plan,
            number,
            ports,
            events,
            sender,
            clock,
            Visibility(plan),
            table,
            self.log,
            self._interrupted,
            network.now_us,
        )
        self._starter = machine.starter
        self._signals = machine.signals
        debug = machine.debug
        self._debugged = table[debug.host] if debug and not debug.debugpy_port else None
        complaints = Complaints(self.log)
        receiver = SyncReceiver(events, ports, number, complaints)
        tick_log = TickLog(core)
        changes = Changes(core, tick_log)
        channels = ChannelRequests(core, changes, tick_log)
        self._hosts = hosts = Hosts(core, machine.starter, receiver, changes, channels)
        times = LoopTimes(plan, table, self.log)
        self._report = WaitReport(core.now_us, hosts.component_at_work, self.log)
        barrier = barrier_of(core, hosts, tick_log, times, self._report)
        continuous = ContinuousHosts(core, tick_log)
        requests, schedule, lifecycle = BoundaryRequests(), Schedule(plan), Lifecycle(plan, table)
        dones = Dones(core, barrier, continuous, requests, tick_log, times, complaints)
        boundary = Boundary(core, hosts, schedule, channels, changes, requests, lifecycle, barrier, tick_log)
        self.loop = Loop(core, boundary, schedule, barrier, continuous, dones, tick_log, times)
        attach = Attach(core, hosts, machine.rings, machine.host_sockets)
        self._control = Control(core, options, hosts, self.loop, changes.settings, lifecycle, attach, machine.listen)
        self._status = StatusReport(core, self.loop)
        self._started = False
        self.wall_s = 0.0
        """Wall time of the main loop, in seconds; known when it has ended."""
        events.after_each_wait(self._publish_status_in_time)
        if machine.signals:
            events.watch(machine.signals, machine.signals.handle)

    @property
    def time_us(self) -> int:
        """Logical time of the newest tick."""
        return self._core.clock.time_us

    def work(self, gateway: GatewayProcess) -> Steps[tuple[str, bool]]:
        """Starts everything and runs the main loop; returns the reason for its end and whether it is a failure."""
        self._core.events.watch(gateway, partial(self._on_gateway_end, gateway))
        try:
            return (yield from self._work())
        except RunBrokenError as broken:
            self.wall_s = self._status.wall_s
            self.log.error(f"{broken}; the run cannot continue")
            return f"broken: {broken}", True

    def stop(self) -> Steps[tuple[status_t, list[str]]]:
        """Stops every process; returns the last view of them, and the components that failed in finalize."""
        self._control.close()
        status = self._publish_status()
        before = self._hosts.failed_components()
        broken = yield from self._stop_hosts()
        self._publish_status()
        after = self._hosts.failed_components()
        self._status.complete(status)
        return status, broken + [f"{name}: {reason}" for name, reason in after.items() if name not in before]

    def _on_gateway_end(self, gateway: GatewayProcess) -> None:
        self._core.events.unwatch(gateway)
        raise RunBrokenError(f"the gateway ended: {gateway.gateway_end()}")

    def _work(self) -> Steps[tuple[str, bool]]:
        # Until the gateway listens: it would miss earlier messages.
        yield from self.loop.tick_log.wait_for(0, self._interrupted)
        try:
            yield from self._hosts.start_all(self._report)
        except StartFailedError as failure:
            self.log.error(f"not started:\n{failure}")
            return f"not started: {failure}", True
        for entry in self._core.hosts:
            entry.fresh_code = self._options.watch
        self._status, self._started = StatusReport(self._core, self.loop), True
        while not self._interrupted() and not self._done():
            yield from self.loop.run_tick()
        self._started = False
        self.wall_s = self._status.wall_s
        yield from self.loop.finish()
        broken = [f"{entry.name}: {entry.reason}" for entry in self._core.hosts if entry.failed]
        if broken:
            return f"failed: {'; '.join(broken)}", True
        return (INTERRUPTED if self._interrupted() else f"{self.loop.tick} ticks done"), False

    def _stop_hosts(self) -> Steps[list[str]]:
        """Stops all hosts, even if other processes end in between; returns the ends of those."""
        broken: list[str] = []
        while True:
            try:
                for name in (yield from self._hosts.stop_all()):
                    self.log.warning(f"{name} did not stop when asked; killed")
                return broken
            except RunBrokenError as one:
                broken.append(f"{one} while everything was being stopped")
                self.log.error(broken[-1])

    def _done(self) -> bool:
        ticks, time_s = self._options.ticks, self._options.time_s
        return (ticks is not None and self.loop.tick >= ticks) or (
            time_s is not None and self._core.clock.time_us >= round(time_s * US_PER_S)
        )

    def _interrupted(self) -> bool:
        if not self._signals or not self._signals.received:
            return False
        received = self._signals.received
        if self._debugged and self._debugged.pid and self._debugged.incarnation == 1:
            while signal.SIGINT in received:  # Ctrl-C belongs to a debugger as long as there is one
                received.remove(signal.SIGINT)
                self._starter.signal(self._debugged.pid, signal.SIGINT)
        return bool(received)

    def _publish_status_in_time(self) -> None:
        if self._started and self._status.due:
            self._publish_status()

    def _publish_status(self) -> status_t:
        status = self._status.message()
        self._control.published(status)
        self._hosts.output.look()
        self._core.sender.publish(b"fwk/status", status.encode(), self._core.ports.status)
        return status

"""The supervisor as a participant: owns plan, clock, marks and main loop, and starts and ends every host of the run."""

import signal
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from fwk.bus.complaints import Complaints
from fwk.bus.network import Network, Steps
from fwk.bus.sender import Sender
from fwk.clock import US_PER_S
from fwk.component.images import Ring
from fwk.component.log import Logger
from fwk.engine.visibility import Ledger
from fwk.host.debugger import DebugRequest
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.supervisor.control.control import Control, Listen
from fwk.supervisor.control.status import StatusReport
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.loop import MainLoop
from fwk.supervisor.options import RunBroken, RunOptions
from fwk.supervisor.processes.attach import Places
from fwk.supervisor.processes.hosts import Hosts, StartFailure
from fwk.supervisor.processes.starter import ProcessStarter
from fwk.supervisor.run_clock import Pace
from fwk.supervisor.sync_receiver import SyncReceiver
from lcmtypes.core import log_t, status_t


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
    """Everything that a supervisor uses beside the run's buses; what is left out does not exist."""

    starter: ProcessStarter
    signals: Signals | None = None
    listen: Listen | None = None
    """Opens the control server."""
    rings: Mapping[str, Ring] = field(default_factory=dict)
    """Where the frames of cameras lie."""
    debug: DebugRequest | None = None


class Supervisor:
    """One run of a plan, from the first process to the last."""

    def __init__(self, plan: Plan, options: RunOptions, number: int, network: Network, machine: Machine) -> None:
        self._plan = plan
        self._options = options
        self._ports = Ports.of(plan)
        self._sender = Sender(self._ports.supervisor, network)
        self.pace = Pace(plan, options.speed)
        self.log = Logger("supervisor", self.pace.clock, self._send_log)
        self._events = EventLoop(network)
        receiver = SyncReceiver(self._events, self._ports, number, Complaints(self.log))
        ledger = Ledger(plan)
        self._starter = machine.starter
        self._hosts = Hosts(plan, machine.starter, ledger, self._events, receiver, self.log, self.pace.clock)
        debug = machine.debug
        self._debugged = self._hosts.table[debug.host] if debug and not debug.debugpy_port else None
        self.loop = MainLoop(
            plan,
            number,
            self._hosts,
            ledger,
            self._events,
            receiver,
            self._sender,
            self.pace,
            self.log,
            self._interrupted,
        )
        places = Places(plan, number, self._hosts, self._events, machine.rings)
        self._control = Control(plan, options, self._hosts, self.loop, self._events, self.log, places, machine.listen)
        self._number = number
        self._status = self._status_report()
        self.loop.on_wait = self._publish_status_in_time
        self.wall_s = 0.0
        self._signals = machine.signals
        if machine.signals:
            self._events.watch(machine.signals, machine.signals.handle)

    def work(self, gateway: GatewayProcess) -> Steps[tuple[str, bool]]:
        """Starts everything and runs the main loop; returns why it ended and whether that is a failure."""
        self._events.watch(gateway, partial(self._on_gateway_end, gateway))
        try:
            return (yield from self._work())
        except RunBroken as broken:
            self.wall_s = self._status.wall_s
            self.log.error(f"{broken}; the run cannot go on")
            return f"broken: {broken}", True

    def stop(self) -> Steps[tuple[status_t, list[str]]]:
        """Stops every process; returns the last view of them, and what failed meanwhile: components in finalize."""
        self._control.close()
        status = self._publish_status()
        before = self._hosts.failed_components()
        broken = yield from self._stop_hosts()
        self._publish_status()
        after = self._hosts.failed_components()
        self._status.complete(status)
        return status, broken + [f"{name}: {reason}" for name, reason in after.items() if name not in before]

    def _on_gateway_end(self, gateway: GatewayProcess) -> None:
        self._events.unwatch(gateway)
        raise RunBroken(f"the gateway ended: {gateway.gateway_end()}")

    def _work(self) -> Steps[tuple[str, bool]]:
        # Until the gateway listens: it would miss what is sent before.
        yield from self.loop.records.wait_for(0, self._interrupted)
        try:
            yield from self._hosts.start_all(self._interrupted)
        except StartFailure as failure:
            self.log.error(f"not started:\n{failure}")
            return f"not started: {failure}", True
        for entry in self._hosts.table:
            entry.fresh_code = self._options.watch
        self._status = self._status_report()
        while not self._interrupted() and not self._done():
            yield from self.loop.run_tick()
            self._publish_status_in_time()
        self.wall_s = self._status.wall_s
        yield from self.loop.finish()
        broken = [f"{entry.name}: {entry.reason}" for entry in self._hosts.table if entry.state == "failed"]
        if broken:
            return f"failed: {'; '.join(broken)}", True
        return ("interrupted" if self._interrupted() else f"{self.loop.tick} ticks done"), False

    def _stop_hosts(self) -> Steps[list[str]]:
        """Stops all hosts, whichever other process ends meanwhile; returns how those ended."""
        broken: list[str] = []
        while True:
            try:
                for name in (yield from self._hosts.stop_all()):
                    self.log.warning(f"{name} did not stop when asked; killed")
                return broken
            except RunBroken as one:
                broken.append(f"{one} while everything was being stopped")
                self.log.error(broken[-1])

    def _done(self) -> bool:
        ticks, time_s = self._options.ticks, self._options.time_s
        return (ticks is not None and self.loop.tick >= ticks) or (
            time_s is not None and self.pace.time_us >= round(time_s * US_PER_S)
        )

    def _interrupted(self) -> bool:
        if not self._signals or not self._signals.received:
            return False
        received = self._signals.received
        if self._debugged and self._debugged.pid and self._debugged.incarnation == 1:
            while signal.SIGINT in received:  # Ctrl-C is the debugger's as long as there is one
                received.remove(signal.SIGINT)
                self._starter.signal(self._debugged.pid, signal.SIGINT)
        return bool(received)

    def _status_report(self) -> StatusReport:
        return StatusReport(self._number, self._hosts.table, self.loop, self.pace, self._events.now_us)

    def _publish_status_in_time(self) -> None:
        if self._status.due:
            self._publish_status()

    def _publish_status(self) -> status_t:
        status = self._status.message()
        self._control.published(status)
        self._hosts.printed.look()
        self._sender.publish(b"fwk/status", status.encode(), self._ports.status)
        return status

    def _send_log(self, line: log_t) -> None:
        self._sender.publish(b"fwk/log", line.encode(), self._ports.log)

"""The starter of simulated processes: what the supervisor's zygote is on a real machine."""

import signal
from collections.abc import Callable
from functools import partial

from fwk.engine.assignment import Assignment, Start
from fwk.host.continuous import host_of
from fwk.host.crash_marker import CrashMarker
from fwk.host.hooks import ProcessHooks
from fwk.model.plan import Plan
from fwk.supervisor.processes.starter import Ended, Started
from tests.simulation.network import Ether, Signal
from tests.simulation.process import Process
from tests.simulation.world import World

FORK_US = 2_000
"""Wall time from the request for a process to its first step."""
NOTICE_US = 300
"""Wall time from an event to the supervisor's knowledge of it."""


class SimulatedZygote:
    """Starts and signals the hosts of a simulated system."""

    def __init__(self, plan: Plan, run: int, world: World, ether: Ether) -> None:
        self._progress = CrashMarker(len(plan.hosts))
        self.processes: dict[int, Process] = {}
        """All processes so far, by pid."""
        self._plan = plan
        self._run = run
        self._world = world
        self._ether = ether
        self._readable = Signal(ether)
        self._events: list[Started | Ended] = []
        self._newest: dict[int, int] = {}  # host to the pid of its newest process

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there are events."""
        return self._readable.fileno()

    def component_at(self, host: int) -> int:
        """Returns the index of the component that a host executes, or executed when it ended."""
        return self._progress.at(host)

    def debugs(self, host: int) -> bool:
        """Returns whether the first process of a host runs under a debugger: never here."""
        return False

    def process_of(self, host: int) -> Process | None:
        """Returns the living process of a host."""
        process = self.processes.get(self._newest.get(host, 0))
        return process if process and process.alive else None

    def start(self, host: int, start: Start, fresh_code: bool) -> None:
        """Asks for a host process; `Started` comes with the events."""
        world = self._world
        slow_us = int(world.random.random() * world.weather.slow_start_us)
        world.after(FORK_US + slow_us, partial(self._fork, host, start))

    def signal(self, pid: int, number: int) -> None:
        """Signals a host process; does nothing if the process has ended."""
        self._world.after(NOTICE_US, partial(self._signal, pid, number))

    def events(self) -> list[Started | Ended]:
        """Returns what happened since the last call."""
        self._readable.clear()
        found, self._events = self._events, []
        return found

    def close(self) -> None:
        """Ends the zygote; hosts that still run are killed."""
        for process in self.processes.values():
            process.kill()

    def wake(self) -> None:
        """Continues the zygote if it was stopped."""

    def _fork(self, host: int, start: Start) -> None:
        pid = 100 + len(self.processes)
        name = self._plan.hosts[host].name
        name = name if start.incarnation == 1 else f"{name}#{start.incarnation}"
        ended = partial(self._on_end, host, start.incarnation, pid)
        process = Process(name, self._world, self._ether, ended)
        self.processes[pid] = process
        self._newest[host] = pid
        assignment = Assignment(self._plan, host, self._run, start, {}, marker=self._progress)
        hooks = ProcessHooks(stopping=lambda: process.stopping, runs_ahead=True)
        self._world.trace.add(self._world.now_us, name, f"starts as process {pid}")
        process.start(lambda: host_of(assignment, process, hooks).serve())
        self._tell(Started(host, start.incarnation, pid))

    def _on_end(self, host: int, incarnation: int, pid: int, code: int) -> None:
        self._tell(Ended(host, incarnation, pid, code))

    def _tell(self, event: Started | Ended) -> None:
        self._world.after(NOTICE_US, partial(self._arrive, event))

    def _arrive(self, event: Started | Ended) -> None:
        self._events.append(event)
        self._readable.set()

    def _signal(self, pid: int, number: int) -> None:
        process = self.processes[pid]
        actions: dict[int, Callable[[], None]] = {
            signal.SIGKILL: process.kill,
            signal.SIGTERM: process.terminate,
            signal.SIGCONT: process.go_on,
        }
        if process.alive:
            actions[number]()

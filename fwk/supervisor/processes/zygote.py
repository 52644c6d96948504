"""The zygote: a process that has imported everything and forks hosts on request, so that they start quickly."""

import gc
import os
import signal
import socket
from collections.abc import Iterable, Mapping

from fwk.component.images import Ring
from fwk.engine.assignment import Start
from fwk.host.crash_marker import CrashMarker
from fwk.host.debugger import DebugRequest
from fwk.host.process import die_with_parent, end_child, name_process, run_forked, wait_for_end
from fwk.host.profile import ProfileRequest
from fwk.model.plan import Plan
from fwk.supervisor.options import RunBrokenError
from fwk.supervisor.processes.forker import Forker
from fwk.supervisor.processes.starter import Ended, Started
from fwk.supervisor.processes.zygote_link import (
    SignalRequest,
    StartRequest,
    SupervisorEnd,
    ZygoteEnd,
    ZygoteEndedError,
)

_PATIENCE_S = 1.0


class Zygote:
    """The supervisor's side of the zygote."""

    def __init__(
        self,
        plan: Plan,
        run: int,
        rings: Mapping[str, Ring],
        sockets: Mapping[int, socket.socket],
        debug: DebugRequest | None = None,
        profile: ProfileRequest | None = None,
        not_for_hosts: Iterable[socket.socket] = (),
    ) -> None:
        own, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._progress = CrashMarker(len(plan.hosts))
        parent = os.getpid()
        gc.collect()
        gc.freeze()  # hosts share the present memory as long as no process writes to it
        self.pid = os.fork()
        if self.pid == 0:
            own.close()
            for each in not_for_hosts:
                each.close()
            name_process(plan.name, "zygote")
            os.setsid()  # Ctrl-C in the terminal goes to the supervisor alone
            die_with_parent(parent)
            forker = Forker(plan, run, rings, sockets, self._progress, ZygoteEnd(other), debug, profile)
            run_forked(forker.serve)
        other.close()
        self._link = SupervisorEnd(own)
        self._debugged = debug.host if debug else None

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there are events."""
        return self._link.fileno()

    def component_at(self, host: int) -> int:
        """Returns the index of the component that a host executes, or executed when it ended."""
        return self._progress.at(host)

    def debugs(self, host: int) -> bool:
        """Returns whether the first process of a host runs under a debugger."""
        return host == self._debugged

    def start(self, host: int, start: Start, fresh_code: bool) -> None:
        """Asks for a host process; `Started` comes with the events.

        With `fresh_code` the application's modules are imported anew.
        """
        self._link.send(StartRequest(host, start, fresh_code))

    def signal(self, pid: int, number: int) -> None:
        """Signals a host process; does nothing if the process has ended."""
        self._link.send(SignalRequest(pid, number))

    def events(self) -> list[Started | Ended]:
        """Returns what happened since the last call.

        Raises:
            RunBrokenError: the zygote itself ended, and all hosts with it.
        """
        try:
            return self._link.events()
        except ZygoteEndedError as error:
            pid, self.pid = self.pid, 0
            raise RunBrokenError(f"the zygote ended: {wait_for_end(pid)}") from error

    def close(self) -> None:
        """Ends the zygote; hosts that still run are killed."""
        self._link.close()
        if self.pid:
            end_child(self.pid, _PATIENCE_S)

    def wake(self) -> None:
        """Lets the zygote continue if it was stopped."""
        if self.pid:
            os.kill(self.pid, signal.SIGCONT)

"""The zygote: a process that has imported everything and forks hosts when asked, so that they start in no time."""

import contextlib
import dataclasses
import gc
import json
import os
import select
import signal
import socket
import sys
from collections.abc import Mapping
from typing import Any

from fwk.component.images import Ring
from fwk.engine.assignment import Assignment, Start
from fwk.engine.failures import ComponentFailedError
from fwk.engine.runner import Runner
from fwk.host.crash_marker import CrashMarker
from fwk.host.debugger import DebugRequest, debug
from fwk.host.driver import HostDriver
from fwk.host.hot_reload import forget_modules
from fwk.host.memory import limit_memory
from fwk.host.plain_logging import forward_logging
from fwk.host.process import (
    StopSignal,
    die_with_parent,
    end_child,
    give_memory_back,
    run_forked,
    wait_for_end,
)
from fwk.host.profile import Profile, ProfileRequest
from fwk.host.uncaught import log_uncaught
from fwk.model.plan import Plan
from fwk.supervisor.options import RunBroken
from fwk.supervisor.processes.preload import preload
from fwk.supervisor.processes.starter import Ended, Started

_PACKET_MAX = 1 << 20
_PATIENCE_S = 1.0


class Zygote:
    """The supervisor's side of the zygote."""

    def __init__(
        self,
        plan: Plan,
        run: int,
        rings: Mapping[str, Ring],
        debug: DebugRequest | None = None,
        profile: ProfileRequest | None = None,
    ) -> None:
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._progress = CrashMarker(len(plan.hosts))
        parent = os.getpid()
        gc.collect()
        gc.freeze()  # what is here now stays; hosts share its memory as long as nobody touches it
        self.pid = os.fork()
        if self.pid == 0:
            self._socket.close()
            os.setsid()  # Ctrl-C in the terminal goes to the supervisor alone
            die_with_parent(parent)
            run_forked(lambda stop: _Forker(plan, run, rings, self._progress, other, debug, profile).serve(stop))
        other.close()
        self._socket.setblocking(False)
        self._debugged = debug.host if debug else None

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there are events."""
        return self._socket.fileno()

    def component_at(self, host: int) -> int:
        """Returns the index of the component that a host executes, or executed when it ended."""
        return self._progress.at(host)

    def debugs(self, host: int) -> bool:
        """Whether the first process of a host runs under a debugger."""
        return host == self._debugged

    def start(self, host: int, start: Start, fresh_code: bool) -> None:
        """Asks for a host process; `Started` comes with the events.

        With `fresh_code` the application's modules are imported anew.
        """
        self._send({"start": dataclasses.asdict(start), "host": host, "fresh_code": fresh_code})

    def signal(self, pid: int, number: int) -> None:
        """Signals a host process; one that has ended meanwhile is left alone."""
        self._send({"signal": number, "pid": pid})

    def events(self) -> list[Started | Ended]:
        """What happened since the last call.

        Raises:
            RunBroken: the zygote itself ended, and all hosts with it.
        """
        found: list[Started | Ended] = []
        while True:
            try:
                packet, descriptors, _, _ = socket.recv_fds(self._socket, _PACKET_MAX, 2)
            except BlockingIOError:
                return found
            except ConnectionResetError:  # it ended with requests unread
                packet, descriptors = b"", []
            if not packet:
                pid, self.pid = self.pid, 0
                raise RunBroken(f"the zygote ended: {wait_for_end(pid)}")
            event = json.loads(packet)
            if event.pop("event") == "started":
                found.append(Started(**event, streams=(descriptors[0], descriptors[1])))
            else:
                found.append(Ended(**event))

    def close(self) -> None:
        """Ends the zygote; hosts that still run are killed."""
        self._socket.close()
        if self.pid:
            end_child(self.pid, _PATIENCE_S)

    def wake(self) -> None:
        """Lets it go on if somebody has stopped it."""
        if self.pid:
            os.kill(self.pid, signal.SIGCONT)

    def _send(self, request: dict[str, Any]) -> None:
        self._socket.setblocking(True)
        with contextlib.suppress(ConnectionError):  # it ended; its events say so
            self._socket.send(json.dumps(request).encode())
        self._socket.setblocking(False)


class _Forker:
    """The zygote's own side."""

    def __init__(
        self,
        plan: Plan,
        run: int,
        rings: Mapping[str, Ring],
        progress: CrashMarker,
        connection: socket.socket,
        debug: DebugRequest | None,
        profile: ProfileRequest | None,
    ) -> None:
        self._debug = debug
        self._profile = profile
        self._plan = plan
        self._run = run
        self._rings = rings
        self._progress = progress
        self._connection = connection
        self._children: dict[int, tuple[int, int]] = {}

    def serve(self, stop: StopSignal) -> int:
        preload(self._plan)
        gc.collect()
        give_memory_back()  # what a fork costs, and what hosts would fill with other things
        gc.freeze()
        signal.signal(signal.SIGCHLD, lambda _number, _frame: None)  # only to wake us
        # It ends when its connection is closed. Who asks all processes of a run to end, as systemd does, wants them to
        # finalize, and that needs their parent.
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        poller = select.poll()
        poller.register(self._connection, select.POLLIN)
        poller.register(stop.wakeup, select.POLLIN)
        while not stop():
            for descriptor, _ in poller.poll():
                if descriptor == stop.wakeup:
                    os.read(stop.wakeup, 1024)
                elif not self._request():
                    return 0
            self._reap()
        return 0

    def _request(self) -> bool:
        packet = self._connection.recv(_PACKET_MAX)
        if not packet:
            for pid in self._children:
                os.kill(pid, signal.SIGKILL)
            return False
        request = json.loads(packet)
        if "start" in request:
            self._fork(request["host"], Start(**request["start"]), request["fresh_code"])
        elif request["pid"] in self._children:
            os.kill(request["pid"], request["signal"])
        return True

    def _fork(self, host: int, start: Start, fresh_code: bool) -> None:
        incarnation = start.incarnation
        debugged = self._debug if self._debug and self._debug.host == host and incarnation == 1 else None
        profiled = self._profile if self._profile and self._profile.component.host == host else None
        output, output_write = os.pipe()
        errors, errors_write = os.pipe()
        parent = os.getpid()
        pid = os.fork()
        if pid == 0:
            die_with_parent(parent)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            self._connection.close()
            if not debugged:  # who is debugged keeps the terminal
                # A session each: Linux spreads the processes of one session (its autogroup) badly over the processors.
                os.setsid()
                os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
                os.dup2(output_write, 1)
                os.dup2(errors_write, 2)
            for descriptor in (output, output_write, errors, errors_write):
                os.close(descriptor)
            assignment = Assignment(self._plan, host, self._run, start, self._rings, fresh_code, self._progress)
            run_forked(lambda stop: _serve_host(assignment, stop, debugged, profiled))
        os.close(output_write)
        os.close(errors_write)
        self._children[pid] = (host, incarnation)
        event = {"event": "started", "host": host, "incarnation": incarnation, "pid": pid}
        socket.send_fds(self._connection, [json.dumps(event).encode()], [output, errors])
        os.close(output)
        os.close(errors)

    def _reap(self) -> None:
        while self._children:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == 0:
                return
            host, incarnation = self._children.pop(pid)
            with contextlib.suppress(OSError):  # it had started none, or they have ended, too
                os.killpg(pid, signal.SIGKILL)  # programs that its components had started
            code = os.waitstatus_to_exitcode(status)
            event = {"event": "ended", "host": host, "incarnation": incarnation, "pid": pid, "code": code}
            event["core"] = os.WCOREDUMP(status)
            self._connection.send(json.dumps(event).encode())


def _serve_host(
    assignment: Assignment, stop: StopSignal, debugged: DebugRequest | None, profiled: ProfileRequest | None
) -> int:
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    if assignment.fresh_code:
        before = forget_modules(assignment.plan, assignment.host)
        assignment = dataclasses.replace(assignment, before=before)
    limit = assignment.plan.memory_limit_mb(assignment.host)
    if limit:
        limit_memory(limit)
    profile = Profile(profiled, assignment.start.incarnation) if profiled else None
    driver = HostDriver(assignment, stop, profile.runner if profile else Runner)
    log_uncaught(driver.host.log)
    forward_logging(driver.host.current_log)
    try:
        if debugged:
            return debug(debugged, driver.serve)
        driver.serve()
    except ComponentFailedError:
        return 1  # logged and reported already
    finally:
        if profile:
            profile.keep()
    return 0

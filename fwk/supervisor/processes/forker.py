"""The zygote's own side: forks a host when asked and reports its end."""

import contextlib
import dataclasses
import gc
import os
import select
import signal
import socket
import sys
from collections.abc import Mapping

from fwk.component.images import Ring
from fwk.engine.assignment import Assignment, Start
from fwk.engine.failures import ComponentFailedError
from fwk.engine.runner import Runner
from fwk.host.crash_marker import CrashMarker
from fwk.host.debugger import DebugRequest, debug
from fwk.host.driver import HostDriver
from fwk.host.hot_reload import forget_modules
from fwk.host.log_capture import forward_logging, log_uncaught
from fwk.host.process import (
    StopSignal,
    die_with_parent,
    give_memory_back,
    limit_memory,
    limit_opencv,
    name_process,
    run_forked,
)
from fwk.host.profile import Profile, ProfileRequest
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.model.signals import ignore
from fwk.supervisor.processes.cores import core_of, stay_on_core
from fwk.supervisor.processes.preload import preload
from fwk.supervisor.processes.starter import Ended, Started
from fwk.supervisor.processes.zygote_link import StartRequest, ZygoteEnd


class Forker:
    """Forks and reaps host processes."""

    def __init__(
        self,
        plan: Plan,
        run: int,
        rings: Mapping[str, Ring],
        sockets: Mapping[int, socket.socket],
        progress: CrashMarker,
        connection: ZygoteEnd,
        debug: DebugRequest | None,
        profile: ProfileRequest | None,
    ) -> None:
        self._debug = debug
        self._profile = profile
        self._plan = plan
        self._run = run
        self._rings = rings
        self._sockets = sockets
        self._descriptors = {port: each.fileno() for port, each in sockets.items()}
        self._progress = progress
        self._connection = connection
        self._children: dict[int, tuple[int, int]] = {}

    def serve(self, stop: StopSignal) -> int:
        """Serves requests until the supervisor closes the connection; returns the exit code."""
        preload(self._plan)
        limit_opencv()
        gc.collect()
        _forget_lookups()
        give_memory_back()  # things that a fork costs, and that hosts would fill with other contents
        gc.freeze()
        signal.signal(signal.SIGCHLD, lambda _number, _frame: None)  # only to wake this process
        # It ends when its connection is closed: hosts need their parent to finalize when all processes of a run are
        # asked to end at once, as systemd does.
        ignore(signal.SIGTERM)
        poller = select.poll()
        poller.register(self._connection.fileno(), select.POLLIN)
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
        request = self._connection.receive()
        if request is None:
            for pid in self._children:
                os.kill(pid, signal.SIGKILL)
            return False
        if isinstance(request, StartRequest):
            self._fork(request.host, request.start, request.fresh_code)
        elif request.pid in self._children:
            os.kill(request.pid, request.number)
        return True

    def _fork(self, host: int, start: Start, fresh_code: bool) -> None:
        incarnation = start.incarnation
        debugged = self._debug if self._debug and self._debug.host == host and incarnation == 1 else None
        profiled = self._profile if self._profile and self._profile.component.host == host else None
        output, output_write = os.pipe()
        errors, errors_write = os.pipe()
        port = Ports.of(self._plan).host(host)
        _drain(self._sockets[port])
        parent = os.getpid()
        core = core_of(self._plan, host, sorted(os.sched_getaffinity(0)))
        pid = os.fork()
        if pid == 0:
            die_with_parent(parent)
            name_process(self._plan.name, self._plan.hosts[host].name)
            stay_on_core(core)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            self._connection.close()
            if not debugged:  # a debugged process keeps the terminal
                # A session for each: Linux spreads the processes of one session (its autogroup) badly over the
                # processors.
                os.setsid()
                os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
                os.dup2(output_write, 1)
                os.dup2(errors_write, 2)
            for descriptor in (output, output_write, errors, errors_write):
                os.close(descriptor)
            assignment = Assignment(self._plan, host, self._run, start, self._rings, fresh_code, self._progress)
            for other_port, descriptor in self._descriptors.items():
                if other_port != port:  # by number: to close the objects would copy the memory in which they lie
                    os.close(descriptor)
            run_forked(lambda stop: _serve_host(assignment, stop, self._sockets, debugged, profiled), prepared=True)
        os.close(output_write)
        os.close(errors_write)
        self._children[pid] = (host, incarnation)
        self._connection.send(Started(host, incarnation, pid, (output, errors)))
        os.close(output)
        os.close(errors)

    def _reap(self) -> None:
        while self._children:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == 0:
                return
            host, incarnation = self._children.pop(pid)
            with contextlib.suppress(OSError):  # it had started no program, or these have ended, too
                os.killpg(pid, signal.SIGKILL)  # programs that its components had started
            code = os.waitstatus_to_exitcode(status)
            self._connection.send(Ended(host, incarnation, pid, code, os.WCOREDUMP(status)))


def _forget_lookups() -> None:
    """Empties the cache of attribute lookups: a host that replaces an entry would copy the page of the name in it.

    From Python 3.12 on names are never written to.
    """
    if sys.version_info < (3, 12):
        sys._clear_type_cache()


def _drain(source: socket.socket) -> None:
    """Drops datagrams for the host's previous process."""
    with contextlib.suppress(BlockingIOError):
        while True:
            source.recv(1, socket.MSG_DONTWAIT)


def _serve_host(
    assignment: Assignment,
    stop: StopSignal,
    sockets: Mapping[int, socket.socket],
    debugged: DebugRequest | None,
    profiled: ProfileRequest | None,
) -> int:
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    if assignment.fresh_code:
        before = forget_modules(assignment.plan, assignment.host)
        assignment = dataclasses.replace(assignment, before=before)
    limit = assignment.plan.memory_limit_mb(assignment.host)
    if limit:
        limit_memory(limit)
    profile = Profile(profiled, assignment.start.incarnation) if profiled else None
    driver = HostDriver(assignment, stop, profile.runner if profile else Runner, sockets)
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

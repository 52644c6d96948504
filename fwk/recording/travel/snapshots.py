"""Snapshots of a process: forked copies that wait, from which it goes on again.

One process at a time, the front, works and uses the terminal. A snapshot is the former front, which waits; its child is
the front from then on. Going back gives an order to a snapshot, which forks a new front, and ends the present front. A
snapshot ends when every process that could wake it has ended, so all end with the last front.
"""

import contextlib
import os
import pickle
import select
import signal
import socket
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fwk.model.signals import ignore

SNAPSHOTS_MAX = 24
"""Most snapshots that wait at the same time."""
FAILED = 1
_BYTES_MAX = 1 << 20
_FRONT, _GIVEN, _ENDED = "front", "given", "ended"


@dataclass(frozen=True)
class Snapshot:
    """A process that waits."""

    tick: int
    """The tick that it begins with."""
    iterations: int
    """Iterations of the debugged component before."""
    cost_s: float
    """CPU time from the beginning of the replay to it."""
    pid: int
    control: socket.socket
    """Gives it an order."""


class Snapshots:
    """The snapshots that the front can go back to, the oldest first."""

    def __init__(self, session: socket.socket) -> None:
        self._session = session
        self._taken: list[Snapshot] = []

    def take(self, tick: int, iterations: int, cost_s: float) -> Any:
        """Leaves a snapshot behind; returns None, and later, in each front that the snapshot becomes, its order."""
        sys.stdout.flush()
        waits, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        pid, order = os.getpid(), None
        on_interrupt = ignore(signal.SIGINT)
        on_child = ignore(signal.SIGCHLD)  # fronts of the past leave no zombies
        while os.fork():  # the snapshot
            control.close()
            data = _received(waits)
            if not data:
                os._exit(0)
            order = pickle.loads(data)
            waits, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        waits.close()
        signal.signal(signal.SIGINT, on_interrupt)
        signal.signal(signal.SIGCHLD, on_child)
        self._tell(_FRONT, os.getpid())
        self._taken.append(Snapshot(tick, iterations, cost_s, pid, control))
        self._thin_out(cost_s)
        return order

    def last_before(self, fits: Callable[[Snapshot], bool]) -> Snapshot | None:
        """Returns the newest snapshot that fits; None: none does."""
        return next((each for each in reversed(self._taken) if fits(each)), None)

    def go_back(self, to: Snapshot, order: Any) -> None:
        """Ends this process and gives an order to a snapshot; returns only if the snapshot does not exist any more."""
        sys.stdout.flush()
        self._tell(_GIVEN, to.pid)
        try:
            to.control.send(pickle.dumps(order))
        except OSError:
            self._tell(_FRONT, os.getpid())
            self._taken.remove(to)
            return
        os._exit(0)

    def _thin_out(self, cost_s: float) -> None:
        """Ends a snapshot if there are too many: the one that leaves the smallest gap for its distance."""
        if len(self._taken) <= SNAPSHOTS_MAX:
            return
        gaps = [
            ((after.cost_s - before.cost_s) / (cost_s - each.cost_s + 1e-3), place)
            for place, (before, each, after) in enumerate(
                zip(self._taken, self._taken[1:], self._taken[2:], strict=False), start=1
            )
        ]
        gone = self._taken.pop(min(gaps)[1])
        with contextlib.suppress(OSError):
            gone.control.send(b"")
            gone.control.shutdown(socket.SHUT_RDWR)
        gone.control.close()

    def _tell(self, what: str, number: int) -> None:
        self._session.send(pickle.dumps((what, number)))


def run_session(work: Callable[[Snapshots], int]) -> int:
    """Runs work in a forked process that may take snapshots and go back; returns the exit code of its last front."""
    sys.stdout.flush()
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    front = os.fork()
    if front == 0:
        ours.close()
        _run_front(work, theirs)
    theirs.close()
    on_interrupt = ignore(signal.SIGINT)  # Ctrl-C belongs to the front
    try:
        return _end_of(front, ours)
    finally:
        signal.signal(signal.SIGINT, on_interrupt)
        ours.close()
        with contextlib.suppress(ChildProcessError):
            os.waitpid(front, 0)


def _run_front(work: Callable[[Snapshots], int], session: socket.socket) -> None:
    """Works in the front, whichever process that is at the end, and ends it."""
    try:
        code = work(Snapshots(session))
    except BaseException:
        traceback.print_exc()
        code = FAILED
    sys.stdout.flush()
    sys.stderr.flush()
    with contextlib.suppress(OSError):
        session.send(pickle.dumps((_ENDED, code)))
    os._exit(0)


def _end_of(front: int, session: socket.socket) -> int:
    """Waits for the exit code of the last front; `FAILED` if the processes that may be the front have died."""
    watched = {front: os.pidfd_open(front)}
    while True:
        ready, _, _ = select.select([session.fileno(), *watched.values()], [], [], None if watched else 0.0)
        if not ready:
            return FAILED
        if session.fileno() in ready:
            data = session.recv(_BYTES_MAX)
            what, number = pickle.loads(data) if data else (_ENDED, FAILED)
            if what == _ENDED:
                return int(number)
            gone = [*watched] if what == _FRONT else []  # a front whose order does not arrive goes on
        else:
            number, gone = 0, [pid for pid, descriptor in watched.items() if descriptor in ready]
        for pid in gone:
            os.close(watched.pop(pid))
        if number and number not in watched:
            with contextlib.suppress(ProcessLookupError):
                watched[number] = os.pidfd_open(number)


def _received(control: socket.socket) -> bytes:
    try:
        return control.recv(_BYTES_MAX)
    except OSError:
        return b""

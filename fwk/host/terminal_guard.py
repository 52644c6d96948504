"""Runs work in a child of a command and restores the settings of the terminal, however the child ends."""

import os
import select
import signal
import sys
import termios
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from fwk.host.process import StopSignal, die_with_parent, run_forked
from fwk.model.signals import ignore


def run_guarded(work: Callable[[StopSignal], int], run: int) -> int:
    """Runs `work` in a child as long as the process `run` lives; returns its exit code, or minus the signal."""
    with _terminal_as_it_was():
        parent = os.getpid()
        pid = os.fork()
        if pid == 0:
            die_with_parent(parent)
            run_forked(work)
        ignore(signal.SIGINT)  # Ctrl-C belongs to the child
        _wait_for_either(pid, run)
        os.kill(pid, signal.SIGKILL)  # an ended child is left alone
        return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def _wait_for_either(*pids: int) -> None:
    poller = select.poll()
    for pid in pids:
        try:
            poller.register(os.pidfd_open(pid), select.POLLIN)
        except ProcessLookupError:
            return
    poller.poll()


@contextmanager
def _terminal_as_it_was() -> Iterator[None]:
    if not sys.stdin.isatty():
        yield
        return
    before = termios.tcgetattr(sys.stdin)
    try:
        yield
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)

"""Keeps the console out of the way of runs: a process in a session of its own with low priority."""

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from fwk.model.parent_death import die_with_parent

_FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
_AUTOGROUP = Path("/proc/self/autogroup")
"""Niceness of the session: where the kernel groups processes by session, the niceness of a process has no effect on
other sessions."""
_SESSION_NICENESS = 10
"""Where a run needs all processors, the session gets a tenth of one of them: enough to open a page in seconds."""
_LOWEST = 19
_TURN_S = 0.1
"""Least time between two changes of sessions' niceness that the kernel permits to users."""
_TURNS = 100
"""Number of turns in which a process that has got a signal must end; afterwards it is killed."""


def continue_in_background() -> None:
    """Continues in a child process in a session of its own; does not return in the calling process.

    The calling process forwards signals to the child and ends as the child ends; a child that has not ended ten seconds
    after a signal is killed. The child ends with its parent.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    awaited = {*_FORWARDED, signal.SIGCHLD}
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    before = signal.pthread_sigmask(signal.SIG_BLOCK, awaited)  # a signal during the fork waits
    parent = os.getpid()
    child = os.fork()
    if child:
        _end_as(_status_of(child, awaited))
    die_with_parent(parent, signal.SIGTERM)
    os.setsid()
    signal.pthread_sigmask(signal.SIG_SETMASK, before)


def give_way() -> None:
    """Gives this thread and its future threads the lowest priority, and their session a low one."""
    with suppress(OSError):
        _AUTOGROUP.write_text(str(_SESSION_NICENESS))
    with suppress(OSError):
        os.nice(_LOWEST)
    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))


def _status_of(child: int, awaited: set[signal.Signals]) -> int:
    """Forwards signals until the child ends; returns its wait status, 0 if it had to be killed after a signal."""
    turns, hurried = -1, False  # since the last signal; negative: none has come
    while True:
        found = signal.sigwaitinfo(awaited) if turns < 0 else signal.sigtimedwait(awaited, _TURN_S)
        if found and found.si_signo in _FORWARDED:
            os.kill(child, found.si_signo)
            turns = 0
        if turns >= 0:
            hurried = hurried or _hurried(child)
            turns += 1
        if turns == _TURNS:
            os.kill(child, signal.SIGKILL)
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return 0 if turns >= _TURNS else status


def _hurried(child: int) -> bool:
    """Gives a child that is to end the usual priority: it would hardly ever run where no processor is idle.

    Returns whether the kernel has permitted that; soon after another change it does not.
    """
    with suppress(OSError):
        for thread in Path(f"/proc/{child}/task").iterdir():
            os.sched_setscheduler(int(thread.name), os.SCHED_OTHER, os.sched_param(0))
            os.setpriority(os.PRIO_PROCESS, int(thread.name), 0)
    try:
        Path(f"/proc/{child}/autogroup").write_text("0")
    except BlockingIOError:
        return False
    except OSError:  # no sessions' niceness here
        return True
    return True


def _end_as(status: int) -> NoReturn:
    """Ends this process as a child with this wait status ended."""
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        with suppress(OSError, ValueError):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {number})
        os.kill(os.getpid(), number)
    sys.exit(os.waitstatus_to_exitcode(status))

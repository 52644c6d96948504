"""A forked process: its title and limits; it dies with its parent, stops on request, and reports a crash."""

import ctypes
import faulthandler
import os
import re
import resource
import select
import signal
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType

from fwk.model.parent_death import die_with_parent as die_with_parent
from fwk.model.signals import ignore

# Looked up once: a forked process shares with its parent only memory in which neither of them writes.
_LIBC = ctypes.CDLL(None, use_errno=True)
_MALLOPT, _MALLOC_TRIM = _LIBC.mallopt, _LIBC.malloc_trim
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3
_KEPT_BYTES = 32 << 20
_KIB = 1 << 10
_MIB = 1 << 20
_SHORT = 15
"""Bytes that the kernel keeps of a process's short name, which `top` shows."""
_KEEP_ENVIRONMENT = "SPT_NOENV"
"""Setting of setproctitle that leaves alone the memory from which other processes read this one's environment."""

ENDED_WELL = "exit code 0"


def wait_for_end(pid: int) -> str:
    """Waits for a child that is ending; returns how it ended."""
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    return f"killed by signal {-code}" if code < 0 else f"exit code {code}"


def end_child(pid: int, patience_s: float) -> bool:
    """Waits for a child that should end by itself, wakes it if it was stopped (SIGSTOP), kills it after `patience_s`.

    Returns:
        Whether it was killed.
    """
    os.kill(pid, signal.SIGCONT)
    descriptor = os.pidfd_open(pid)
    poller = select.poll()
    poller.register(descriptor, select.POLLIN)
    late = not poller.poll(patience_s * 1000)
    os.close(descriptor)
    if late:
        os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    return late


def raise_file_limit() -> None:
    """Raises the limit of open files to the hard limit: a host needs a socket for each channel."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


def allow_core_dumps() -> None:
    """Lets a crash leave a core dump where the system's limits and its `core_pattern` allow one."""
    _, hard = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (hard, hard))


def keep_memory() -> None:
    """Lets the C library keep freed memory, because returning the memory of each image costs page faults."""
    _MALLOPT(_M_MMAP_THRESHOLD, _KEPT_BYTES)
    _MALLOPT(_M_TRIM_THRESHOLD, _KEPT_BYTES)


def give_memory_back() -> None:
    """Returns freed memory to the system: `init` often frees more than iterations ever need."""
    _MALLOC_TRIM(0)


@cache
def _titles() -> ModuleType:
    """Imports setproctitle, which reads its setting at its first use; forked processes inherit the result."""
    os.environ[_KEEP_ENVIRONMENT] = "1"
    import setproctitle

    setproctitle.getproctitle()
    del os.environ[_KEEP_ENVIRONMENT]
    return setproctitle


def name_process(plan: str, role: str) -> None:
    """Names this process: `fwk: PLAN ROLE` in full, the end of the role in short."""
    titles = _titles()
    titles.setproctitle(f"fwk: {plan} {role}")
    titles.setthreadtitle(role.encode()[-_SHORT:].decode(errors="ignore"))


def limit_memory(mebibytes: float) -> None:
    """Limits private memory to what the process has now plus `mebibytes`; more raises MemoryError.

    Memory shared with the parent process counts as present; shared memory segments do not count.
    """
    status = Path("/proc/self/status").read_text()
    found = re.search(r"^VmData:\s*(\d+) kB", status, re.M)
    had = int(found[1]) * _KIB if found else 0
    resource.setrlimit(resource.RLIMIT_DATA, (had + round(mebibytes * _MIB), resource.RLIM_INFINITY))


def lift_limit() -> None:
    """Removes the limit, because reporting a failure needs memory too."""
    resource.setrlimit(resource.RLIMIT_DATA, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))


class StopSignal:
    """Becomes true when the process is asked to stop; `wakeup` becomes readable at every signal that has a handler."""

    def __init__(self) -> None:
        self.wakeup, self._write = os.pipe()
        os.set_blocking(self.wakeup, False)
        os.set_blocking(self._write, False)
        self._set = False
        signal.set_wakeup_fd(self._write, warn_on_full_buffer=False)
        signal.signal(signal.SIGTERM, self._on_signal)
        ignore(signal.SIGINT)  # the supervisor handles Ctrl-C

    def __call__(self) -> bool:
        return self._set

    def on_interrupt(self, ends: bool) -> None:
        """Sets whether Ctrl-C asks the process to stop or is ignored."""
        if ends:
            signal.signal(signal.SIGINT, self._on_signal)
        else:
            ignore(signal.SIGINT)

    def _on_signal(self, _number: int, _frame: object) -> None:
        self._set = True


def limit_opencv() -> None:
    """Limits OpenCV to one thread, if the components have imported it."""
    if opencv := sys.modules.get("cv2"):
        opencv.setNumThreads(1)


def run_forked(work: Callable[[StopSignal], int], prepared: bool = False) -> None:
    """Runs `work` as the whole rest of a forked child; never returns to the parent's code.

    Args:
        work: takes the signal to stop; returns the exit code.
        prepared: whether the parent ran by this function, too, so that the child has inherited the preparations.
    """
    code = 1
    try:
        if not prepared:
            faulthandler.enable()
            allow_core_dumps()
            keep_memory()
            limit_opencv()
        code = work(StopSignal())
    except BaseException as error:
        if not isinstance(error, SystemExit):
            sys.excepthook(type(error), error, error.__traceback__)
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)

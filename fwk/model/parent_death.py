"""Death of a process with its parent, arranged by the kernel."""

import ctypes
import os
import signal

_PRCTL = ctypes.CDLL(None, use_errno=True).prctl
"""Looked up once: a forked process shares with its parent only memory in which neither of them writes."""
_PR_SET_PDEATHSIG = 1


def die_with_parent(parent: int, death_signal: int = signal.SIGKILL) -> None:
    """Asks the kernel to send this process `death_signal` when `parent` ends in any way."""
    _PRCTL(_PR_SET_PDEATHSIG, death_signal)
    if os.getppid() != parent:  # the parent has ended before this call
        os._exit(1)

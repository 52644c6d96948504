"""Ignoring of a signal that may come at any time."""

import signal
from typing import Any


def ignore(number: signal.Signals) -> Any:
    """Ignores a signal from now on; returns the handler that it had, which takes those that came before.

    `signal.signal` alone lets Python print a traceback when the signal comes during the call, because its handler is
    gone once Python looks for it.
    """
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [])
    try:
        signal.pthread_sigmask(signal.SIG_BLOCK, [number])  # runs the handler of those that came before
        return signal.signal(number, signal.SIG_IGN)  # the kernel drops those that have come since
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)

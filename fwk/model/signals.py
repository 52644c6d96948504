"""Ignoring of a signal that may come at any time."""

import ctypes
import signal
from typing import Any

_set_kernel_handler = ctypes.CDLL(None).signal
_set_kernel_handler.argtypes = [ctypes.c_int, ctypes.c_void_p]
_set_kernel_handler.restype = ctypes.c_void_p


def ignore(number: signal.Signals) -> Any:
    """Ignores a signal from now on; returns the handler that it had, which takes those that came before.

    `signal.signal` alone lets Python print a traceback when the signal comes during the call, because its handler is
    gone once Python looks for it.
    """
    _set_kernel_handler(number, signal.SIG_IGN)  # none comes any more
    return signal.signal(number, signal.SIG_IGN)  # first runs the handler of those that came

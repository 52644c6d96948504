"""Signals that ask a run to end, as a source of events."""

import os
import signal

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class StopSignals:
    """Collects the signals that ask this process to end; a descriptor is readable when one came."""

    def __init__(self) -> None:
        self.received: list[int] = []
        self._wakeup, write = os.pipe()
        os.set_blocking(self._wakeup, False)
        os.set_blocking(write, False)
        signal.set_wakeup_fd(write, warn_on_full_buffer=False)
        for number in ENDING:
            signal.signal(number, lambda received, _frame: self.received.append(received))

    def fileno(self) -> int:
        """Returns the descriptor that is readable when a signal came."""
        return self._wakeup

    def handle(self) -> None:
        """Clears the descriptor."""
        os.read(self._wakeup, 1024)

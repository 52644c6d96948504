"""A signal that comes while a process begins to ignore it leaves no traceback."""

import os
import signal
import subprocess
import sys

import pytest

from fwk.model.signals import ignore

SENDER = "import os, sys\nwhile os.getppid() == int(sys.argv[1]):\n    os.kill(int(sys.argv[1]), int(sys.argv[2]))"


def test_a_signal_during_the_change_leaves_no_traceback(capfd: pytest.CaptureFixture[str]) -> None:
    taken = []
    before = signal.signal(signal.SIGUSR1, lambda number, _: taken.append(number))
    sender = subprocess.Popen([sys.executable, "-c", SENDER, str(os.getpid()), str(signal.SIGUSR1.value)])
    try:
        while len(taken) < 100:
            handler = ignore(signal.SIGUSR1)
            assert signal.getsignal(signal.SIGUSR1) == signal.SIG_IGN
            signal.signal(signal.SIGUSR1, handler)
    finally:
        sender.kill()
        sender.wait()
        ignore(signal.SIGUSR1)
        signal.signal(signal.SIGUSR1, before)
    assert capfd.readouterr().err == ""

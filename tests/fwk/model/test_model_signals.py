"""A signal that comes while a process begins to ignore it leaves no traceback."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

SENDER = """
import os, sys
while os.getppid() == int(sys.argv[1]):
    os.kill(int(sys.argv[2]), int(sys.argv[3]))
"""
IGNORING = """
import signal
from fwk.model.signals import ignore

taken = []
signal.signal(signal.SIGUSR1, lambda number, _: taken.append(number))
print("ready", flush=True)
while len(taken) < 300:
    handler = ignore(signal.SIGUSR1)
    assert signal.getsignal(signal.SIGUSR1) == signal.SIG_IGN
    signal.signal(signal.SIGUSR1, handler)
ignore(signal.SIGUSR1)
"""


@pytest.fixture
def ignoring() -> Iterator[subprocess.Popen[str]]:
    """A process of one thread, as those of a run are, that ignores a signal and takes it in turns."""
    words = [sys.executable, "-c", IGNORING]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        yield process
        process.kill()


@pytest.mark.slow
def test_a_signal_during_the_change_leaves_no_traceback(ignoring: subprocess.Popen[str]) -> None:
    assert ignoring.stdout
    assert ignoring.stdout.readline() == "ready\n"
    numbers = map(str, (os.getpid(), ignoring.pid, signal.SIGUSR1.value))
    sender = subprocess.Popen([sys.executable, "-c", SENDER, *numbers], stderr=subprocess.DEVNULL)
    _, said = ignoring.communicate()
    sender.kill()
    sender.wait()
    assert (ignoring.returncode, said) == (0, "")

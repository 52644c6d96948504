"""A signal that comes while a process begins to ignore it leaves no traceback."""

import os
import signal
from multiprocessing import get_context

import pytest

from fwk.model.signals import ignore


def _send(number: signal.Signals, pid: int) -> None:
    while os.getppid() == pid:
        os.kill(pid, number)


def test_a_signal_during_the_change_leaves_no_traceback(capfd: pytest.CaptureFixture[str]) -> None:
    taken = []
    before = signal.signal(signal.SIGUSR1, lambda number, _: taken.append(number))
    sender = get_context("fork").Process(target=_send, args=(signal.SIGUSR1, os.getpid()))
    sender.start()
    try:
        while len(taken) < 300:
            handler = ignore(signal.SIGUSR1)
            assert signal.getsignal(signal.SIGUSR1) == signal.SIG_IGN
            signal.signal(signal.SIGUSR1, handler)
    finally:
        sender.kill()
        sender.join()
        ignore(signal.SIGUSR1)
        signal.signal(signal.SIGUSR1, before)
    assert capfd.readouterr().err == ""


def test_a_blocked_signal_stays_blocked_and_is_dropped() -> None:
    before = signal.signal(signal.SIGUSR1, signal.default_int_handler)
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGUSR1])
    try:
        os.kill(os.getpid(), signal.SIGUSR1)
        assert ignore(signal.SIGUSR1) == signal.default_int_handler
        assert signal.SIGUSR1 in signal.pthread_sigmask(signal.SIG_BLOCK, [])
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGUSR1])
        signal.signal(signal.SIGUSR1, before)

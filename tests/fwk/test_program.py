"""End of a program."""

import errno
import signal

import pytest

from fwk.program import run_program


def test_too_few_descriptors_are_a_sentence() -> None:
    def fail() -> int:
        raise OSError(errno.EMFILE, "Too many open files")

    before = signal.getsignal(signal.SIGINT)
    try:
        with pytest.raises(SystemExit) as ended:
            run_program(fail)
    finally:
        signal.signal(signal.SIGINT, before)
    assert ended.value.code == 2

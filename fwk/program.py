"""Program: its exit codes, its errors, and its end in a sentence, whatever happens to the terminal or the machine."""

import errno
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn

FAILED = 1
BAD_INPUT = 2
INTERRUPTED = 130


def complain(text: str) -> None:
    """Prints an error to stderr."""
    print(f"error: {text}", file=sys.stderr)


def notice(text: str) -> None:
    """Prints a note to stderr."""
    print(f"note: {text}", file=sys.stderr)


def run_program(program: Callable[[], int | None], interrupted: int = INTERRUPTED) -> NoReturn:
    """Runs a program to its exit code and exits with it; the machine's failures end it with a sentence and code 2.

    `interrupted` is the exit code after Ctrl-C before the program handles Ctrl-C itself.
    """
    signal.signal(signal.SIGINT, lambda *_: _interrupt(interrupted))
    _open_closed_streams()
    code: int | str | None
    try:
        _need_folder()
        code = program()
        sys.stdout.flush()
    except SystemExit as end:
        code = end.code
        try:
            sys.stdout.flush()
        except OSError as error:
            code = _ended(error)
    except KeyboardInterrupt:
        code = interrupted
    except OSError as error:
        code = _ended(error)
    sys.exit(code)


def imported() -> None:
    """Gives Ctrl-C back to Python: the imports are done, and interrupts raise `KeyboardInterrupt` from now on."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def _interrupt(code: int) -> NoReturn:
    """Ends the process at once: imports that are cut off in the middle raise errors of all kinds."""
    os.write(2, b"interrupted before the start\n")
    os._exit(code)


def _need_folder() -> None:
    try:
        os.getcwd()
    except OSError:
        complain("the current folder does not exist any more; change to another one with cd")
        raise SystemExit(BAD_INPUT) from None


def _open_closed_streams() -> None:
    """Opens /dev/null in place of closed standard streams, so that no file or socket takes their descriptors."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if getattr(sys, name) is None:
            null = os.open(os.devnull, os.O_RDWR)
            if null != number:
                os.dup2(null, number)
                os.close(null)
            setattr(sys, name, open(number, mode, closefd=False))  # noqa: SIM115 - stays open until the end


def _ended(error: OSError) -> int:
    """Explains a failure of the machine and returns the exit code.

    Raises:
        OSError: any other failure, which is a defect.
    """
    if error.errno == errno.EPIPE:  # the reader of a pipe, such as `head`, has enough
        _discard_output()
        return FAILED
    if error.errno in (errno.EMFILE, errno.ENFILE):
        complain("too many open files; allow more with: ulimit -n 1024")
    elif error.errno in (errno.ENOSPC, errno.EIO, errno.EBADF) and not error.filename:
        _discard_output()
        complain(f"the output cannot be written: {error.strerror}")
    elif error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM) and error.filename:
        complain(f"{error.filename}: {error.strerror}")
    elif error.errno in (errno.ENOMEM, errno.EAGAIN):
        complain(f"the machine has no memory or processes left: {error.strerror}")
    else:
        raise error
    return BAD_INPUT


def _discard_output() -> None:
    """Discards buffered output, so that the interpreter does not fail on it at its end."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())

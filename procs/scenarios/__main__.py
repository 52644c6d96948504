"""`python -m procs.scenarios`."""

import errno
import os
import signal
import sys
from collections.abc import Callable

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def _program() -> int:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C during the imports ends the process at once
    from procs.scenarios.command import main

    signal.signal(signal.SIGINT, signal.default_int_handler)
    return main()


def code_of(program: Callable[[], int]) -> int:
    """Runs a program and returns its exit code; Ctrl-C and an output that cannot be written end it in a sentence.

    Raises:
        OSError: any other failure of the machine.
    """
    try:
        try:
            code = program()
        except KeyboardInterrupt:
            code = INTERRUPTED
        except SystemExit as end:  # of the command line
            code = end.code if isinstance(end.code, int) else BAD_INPUT
        if sys.stdout:
            sys.stdout.flush()
        return code
    except OSError as error:
        if error.filename or error.errno not in (errno.EPIPE, errno.ENOSPC, errno.EIO, errno.EBADF):
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left is not written again at the end
        if error.errno == errno.EPIPE:  # the reader, such as `head`, has enough
            return FAILED
        print(f"error: the output cannot be written: {error.strerror}", file=sys.stderr)
        return BAD_INPUT


if __name__ == "__main__":
    sys.exit(code_of(_program))

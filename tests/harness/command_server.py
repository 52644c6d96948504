"""Starts the commands of fwk by fork, with all imports done; a program of its own, started by `commands.py`.

`python -P command_server.py DESCRIPTOR` reads requests from a socket until it is closed. A request is a JSON object and
four descriptors: standard input, output, error, and a pipe to which the server writes the command's process number and,
at its end, how it ended.
"""

import ctypes
import fcntl
import gc
import inspect
import json
import os
import selectors
import signal
import socket
import sys
import termios
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any, NoReturn

import fwk
import fwk.cli  # limits linear algebra to one thread before numpy is imported, as in the commands
from fwk.host.process import die_with_parent
from fwk.plan.packages import component_packages

MARK = "FWK_TEST_RUN"
"""Variable of the environment by which the harness finds the processes of a run."""
MARK_CHARACTERS = 32
REQUEST_BYTES = 1 << 17
_PROGRAMS = {"fwk": "fwk.cli.main", "fwk-launch": "fwk.cli.launch"}
_LIBRARIES = ("cv2",)
_NOT_IMPORTED = ("fwk.log_tools", "fwk.packaging", "fwk.scaffold", "fwk.testing", "fwk.web")
"""Packages that few commands need, with libraries that take longer to import than all others together."""


class Server:
    """Forks commands and reports their ends."""

    def __init__(self, requests: socket.socket) -> None:
        self._requests = requests
        self._reports: dict[int, int] = {}
        self._ends, wakeup = os.pipe()
        os.set_blocking(self._ends, False)
        os.set_blocking(wakeup, False)
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the tests, which end their commands
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(wakeup)

    def serve(self) -> tuple[dict[str, Any], list[int]]:
        """Returns a request and its standard streams, in the process that has to carry it out."""
        with selectors.DefaultSelector() as selector:
            selector.register(self._requests, selectors.EVENT_READ)
            selector.register(self._ends, selectors.EVENT_READ)
            while True:
                ready = {key.fileobj for key, _ in selector.select()}
                if self._ends in ready:
                    self._report_ends()
                if self._requests in ready:
                    data, descriptors, _, _ = socket.recv_fds(self._requests, REQUEST_BYTES, 4)
                    if not data:
                        sys.exit()
                    server = os.getpid()
                    pid = os.fork()
                    if not pid:
                        _leave(server)
                        return json.loads(data), descriptors[:3]
                    self._reports[pid] = descriptors.pop()
                    os.write(self._reports[pid], f"{pid}\n".encode())
                    for descriptor in descriptors:
                        os.close(descriptor)

    def _report_ends(self) -> None:
        os.read(self._ends, 1 << 12)
        while self._reports:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if not pid:
                return
            report = self._reports.pop(pid)
            os.write(report, f"{os.waitstatus_to_exitcode(status)}\n".encode())
            os.close(report)


def _leave(server: int) -> None:
    """Makes a fork of the server an ordinary process, which ends when the server ends."""
    die_with_parent(server, signal.SIGTERM)
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)


def carry_out(request: dict[str, Any], streams: list[int]) -> NoReturn:
    """Runs a command as its script in the environment's `bin` would run it."""
    if request["session"] or request["terminal"]:
        os.setsid()
    _mark(request["environment"].get(MARK, ""))
    os.environ.clear()
    os.environ.update(request["environment"])
    os.chdir(request["folder"])
    for number, descriptor in enumerate(streams):
        os.dup2(descriptor, number)
    if request["terminal"]:
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    os.closerange(3, max(int(name) for name in os.listdir("/proc/self/fd")) + 1)
    sys.stdin = open(0)  # noqa: SIM115 - the streams stay open until the end
    sys.stdout = open(1, "w")  # noqa: SIM115
    sys.stderr = open(2, "w", errors="backslashreplace", buffering=1)  # noqa: SIM115
    sys.argv = request["command"]
    program = Path(sys.argv[0])
    sys.path.insert(0, str(program.parent))
    import_module(_PROGRAMS[program.name]).main()
    sys.exit()


def _mark(mark: str) -> None:
    """Writes the mark to where /proc/PID/environ shows it; setting the variable does not reach that memory."""
    libc = ctypes.CDLL(None)
    libc.getenv.restype = ctypes.c_void_p
    ctypes.memmove(libc.getenv(MARK.encode()), mark.ljust(MARK_CHARACTERS).encode(), MARK_CHARACTERS)


def import_all() -> None:
    """Imports what commands import, so that their processes share it."""
    for module in walk_packages(fwk.__path__, "fwk."):
        if not module.name.startswith(_NOT_IMPORTED) and not module.name.endswith("__main__"):
            import_module(module.name)
    for name in _LIBRARIES:
        import_module(name)
    os.environ["SPT_NOENV"] = "1"  # keeps the environment where /proc/PID/environ shows it
    import_module("setproctitle").getproctitle()  # finds the title's memory, which it cannot once `carry_out` has begun
    del os.environ["SPT_NOENV"]
    component_packages()  # these two remember what they read of the disk
    inspect.getmodule(inspect.currentframe())
    gc.collect()
    gc.freeze()


if __name__ == "__main__":
    import_all()
    carry_out(*Server(socket.socket(fileno=int(sys.argv[1]))).serve())

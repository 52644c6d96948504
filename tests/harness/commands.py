"""Starts the commands of fwk as often as tests need them, without importing fwk anew each time.

Most of the time of a short command is its imports. So a server (`command_server.py`) imports once and forks each
command; the tests of what happens before the imports are done, and of the installed package, start the real scripts.
"""

import atexit
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from functools import cache, partial
from itertools import count
from pathlib import Path

from fwk.host.process import die_with_parent
from tests.harness.command_server import MARK, MARK_CHARACTERS, REQUEST_BYTES

BIN = Path(sys.executable).parent
_SERVER = Path(__file__).with_name("command_server.py")
_FORKED_WITH = ("HOME", "PATH", "LD_LIBRARY_PATH", "FWK_TEST_", "PYTEST_")
"""Beginnings of the names of variables that nothing reads while it is imported."""
_ENVIRONMENT = dict(os.environ)
_RUNS = count()


class Command:
    """A forked command, used like `subprocess.Popen`."""

    def __init__(self, report: int) -> None:
        self._report = report
        self.returncode: int | None = None
        self.pid = self._next(None) or 0

    def poll(self) -> int | None:
        """Returns the exit code, negative for a signal; None while it runs."""
        return self._ended(0)

    def wait(self, timeout: float | None = None) -> int:
        """Waits for the end; returns the exit code.

        Raises:
            subprocess.TimeoutExpired: It runs after `timeout` seconds.
        """
        code = self._ended(timeout)
        if code is None:
            raise subprocess.TimeoutExpired(str(self.pid), timeout or 0.0)
        return code

    def send_signal(self, number: int) -> None:
        """Signals the process, if it has not ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def _ended(self, timeout_s: float | None) -> int | None:
        if self.returncode is None:
            self.returncode = self._next(timeout_s)
            if self.returncode is not None:
                os.close(self._report)
        return self.returncode

    def _next(self, timeout_s: float | None) -> int | None:
        """Returns the next number that the server reports; None if it reports none in time."""
        if not select.select([self._report], [], [], timeout_s)[0]:
            return None
        line = b""
        while not line.endswith(b"\n"):
            read = os.read(self._report, 1)
            assert read, "the server of commands has ended"
            line += read
        return int(line)


def start(
    command: list[str],
    folder: Path,
    environment: dict[str, str],
    output: int,
    error: int,
    *,
    session: bool = False,
    terminal: int | None = None,
) -> "Command | subprocess.Popen[bytes]":
    """Starts `fwk` or `fwk-launch`, given by its path in `BIN`, with these words.

    `terminal` is its standard input and controls its session; a command in a terminal is always forked.
    Programs before it, as `unshare`, and variables that libraries read while they are imported need a real start.
    """
    if Path(command[0]).parent == BIN and all(
        key.startswith(_FORKED_WITH) or key == MARK for key, _ in environment.items() ^ _ENVIRONMENT.items()
    ):
        request = {
            "command": command,
            "folder": str(folder),
            "environment": environment,
            "session": session,
            "terminal": terminal is not None,
        }
        data = json.dumps(request).encode()
        if len(data) < REQUEST_BYTES:
            # Two runs and a run and its replay never have a server in common: sets are in another order in each.
            return _forked(
                data, next(_RUNS) % 2 if Path(command[0]).name == "fwk-launch" else 2, terminal, output, error
            )
    assert terminal is None, f"cannot be forked: {command}"
    return subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=error,
        start_new_session=session,
        preexec_fn=partial(die_with_parent, os.getpid(), signal.SIGTERM),  # when the test run is killed
    )


def run(
    command: list[str], folder: Path, environment: dict[str, str], timeout_s: float, *, together: bool = False
) -> "subprocess.CompletedProcess[str]":
    """Runs a command to its end; `together` takes standard error for standard output."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as error:
        started = start(command, folder, environment, output.fileno(), (output if together else error).fileno())
        try:
            code = started.wait(timeout_s)
        except subprocess.TimeoutExpired:
            started.send_signal(signal.SIGKILL)
            raise
        output.seek(0)
        error.seek(0)
        said, complained = (each.read().decode(errors="replace") for each in (output, error))
        return subprocess.CompletedProcess(command, code, said, complained)


def _forked(request: bytes, server: int, terminal: int | None, output: int, error: int) -> Command:
    report, reports = os.pipe()
    typed = os.open(os.devnull, os.O_RDONLY) if terminal is None else os.dup(terminal)
    socket.send_fds(_server(server), [request], [typed, output, error, reports])
    os.close(typed)
    os.close(reports)
    return Command(report)


@cache
def _server(number: int) -> socket.socket:
    """Returns the connection to a server of its own hash seed."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    server = subprocess.Popen(
        [sys.executable, "-P", str(_SERVER), str(theirs.fileno())],
        env={**_ENVIRONMENT, MARK: " " * MARK_CHARACTERS},
        stdin=subprocess.DEVNULL,
        pass_fds=[theirs.fileno()],
        preexec_fn=partial(_begin_server, os.getpid()),
    )
    theirs.close()
    atexit.register(_end, server, ours)
    return ours


def _begin_server(parent: int) -> None:
    die_with_parent(parent, signal.SIGTERM)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # commands hear it also if the test run ignores it, as under nohup


def _end(server: "subprocess.Popen[bytes]", connection: socket.socket) -> None:
    connection.close()
    server.wait()

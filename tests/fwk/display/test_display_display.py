"""The display process on a real terminal and on a pipe."""

import io
import os
import pty
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from fwk.display import display as display_module
from fwk.display.view import View
from lcmtypes.core import log_t, status_t
from lcmtypes.soccer import game_state_t
from tests.fwk.cli.cli_runs import TRACKER, game_state, log, packet, plan, status

HIDE_CURSOR, SHOW_CURSOR = "\x1b[?25l", "\x1b[?25h"
PROGRAM = """
import socket, sys
from fwk.display.display import run_display
from tests.fwk.cli.cli_runs import plan
run_display(plan("tests.fwk.cli.cli_runs:headline"), socket.socket(fileno=int(sys.argv[1])), sys.argv[2] == "plain")
"""


class Display:
    """A display process; `send` what the supervisor would, `read` what it shows."""

    def __init__(self, style: str, terminal: bool) -> None:
        self._supervisor, end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._out, out = pty.openpty() if terminal else os.pipe()
        command = [sys.executable, "-c", PROGRAM, str(end.fileno()), style]
        self.process = subprocess.Popen(command, stdout=out, pass_fds=[end.fileno()])
        end.close()
        os.close(out)
        self.shown = ""

    def send(self, channel: str, message: status_t | log_t | game_state_t) -> None:
        self._supervisor.send(packet(channel, message))

    def send_raw(self, data: bytes) -> None:
        self._supervisor.send(data)

    def read_until(self, text: str) -> None:
        while text not in self.shown:
            chunk = self._read()
            assert chunk, f"ended without showing {text!r}, but: {self.shown}"
            self.shown += chunk

    def close(self) -> int:
        """Ends the run; returns the display's exit code, with all that it showed in `shown`."""
        self._supervisor.close()
        while chunk := self._read():
            self.shown += chunk
        os.close(self._out)
        return self.process.wait(10)

    def _read(self) -> str:
        try:
            return os.read(self._out, 65536).decode(errors="replace")
        except OSError:  # a terminal whose other side is closed
            return ""


@pytest.fixture
def start() -> Iterator[Callable[..., Display]]:
    with _ended([]) as started:

        def start(style: str = "live", terminal: bool = True) -> Display:
            started.append(Display(style, terminal))
            return started[-1]

        yield start


@contextmanager
def _ended(started: list[Display]) -> Iterator[list[Display]]:
    yield started
    for display in started:
        if display.process.poll() is None:
            display.process.kill()
            display.process.wait()


def test_on_a_terminal_it_draws_and_gives_the_cursor_back_when_the_run_ends(start: Callable[..., Display]) -> None:
    display = start()
    display.send("fwk/status", status(TRACKER, 77))
    display.read_until("tick 77")
    assert HIDE_CURSOR in display.shown
    display.send("fwk/status", status(TRACKER, 78))
    assert display.close() == 0
    assert "tick 78" in display.shown
    assert SHOW_CURSOR in display.shown.rpartition("tick 78")[2]


def test_on_a_pipe_it_writes_lines_without_escape_codes(start: Callable[..., Display]) -> None:
    display = start(terminal=False)
    display.send("world/game_state", game_state(1, 0))
    display.send("fwk/status", status(TRACKER, 77))
    display.send("fwk/log", log("found the ball"))
    assert display.close() == 0
    state, line = display.shown.splitlines()
    assert state.startswith("tick 77   3.85 s   speed 1.00   20.0 ticks/s   2 running   lost 0")
    assert state.endswith("CYAN 1 : 0 MAGENTA")
    assert line.endswith(" 40     2.000 s info    cyan1/tracker: found the ball (tracker.py:12)")
    assert "\x1b" not in display.shown


def test_while_a_run_stands_still_nothing_is_written_into_a_debuggers_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(display_module, "_STATUS_LINE_S", 1e-6)
    view, out = View(plan("tests.fwk.cli.cli_runs:headline")), io.StringIO()
    supervisor, end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with end:
        for tick, repeated in ((77, 1), (77, 50), (77, 100), (78, 100)):
            supervisor.send(packet("fwk/status", status(TRACKER, tick, repeated=repeated)))
        supervisor.close()
        display_module.show_lines(view, end, out)
    assert [line.split()[1] for line in out.getvalue().splitlines()] == ["77", "78"]


def test_plain_means_lines_on_a_terminal_too(start: Callable[..., Display]) -> None:
    display = start("plain")
    display.send("fwk/log", log("found the ball"))
    assert display.close() == 0
    assert "found the ball" in display.shown
    assert "\x1b" not in display.shown


def test_ctrl_c_is_left_to_the_supervisor(start: Callable[..., Display]) -> None:
    display = start()
    display.send("fwk/status", status(TRACKER, 1))
    display.read_until("tick 1 ")
    display.process.send_signal(signal.SIGINT)
    display.send("fwk/status", status(TRACKER, 2))
    display.read_until("tick 2 ")
    assert display.close() == 0


def test_ended_by_force_it_still_gives_the_cursor_back(start: Callable[..., Display]) -> None:
    display = start()
    display.send("fwk/status", status(TRACKER, 1))
    display.read_until("tick 1 ")
    display.process.terminate()
    assert display.close() == 128 + signal.SIGTERM
    assert SHOW_CURSOR in display.shown


def test_a_packet_that_does_not_decode_is_passed_over(start: Callable[..., Display]) -> None:
    display = start(terminal=False)
    display.send_raw(b"fwk/status\0rubbish")
    display.send_raw(b"no zero byte")
    display.send("fwk/status", status(TRACKER, 5))
    assert display.close() == 0
    assert display.shown.startswith("tick 5 ")

"""The display process on a real terminal and on a pipe."""

import fcntl
import io
import os
import pty
import signal
import socket
import subprocess
import sys
import termios
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from fwk.display import display as display_module
from fwk.display.floods import PRINTED_MAX, FloodGate, LineGroups
from fwk.display.keys import Keyboard, restore
from fwk.display.live import press
from fwk.display.steering import Steering
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
    """A display process; `send` plays the supervisor, `read` returns what the display shows."""

    def __init__(self, style: str, terminal: bool, keys: bool = False) -> None:
        self._supervisor, end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._out, out = pty.openpty() if terminal else os.pipe()
        command = [sys.executable, "-c", PROGRAM, str(end.fileno()), style]
        self.process = subprocess.Popen(
            command,
            stdin=out if keys else subprocess.DEVNULL,
            stdout=out,
            pass_fds=[end.fileno()],
            start_new_session=keys,
            preexec_fn=(lambda: fcntl.ioctl(1, termios.TIOCSCTTY, 0)) if keys else None,
        )
        end.close()
        os.close(out)
        self.shown = ""

    def send(self, channel: str, message: status_t | log_t | game_state_t) -> None:
        self._supervisor.send(packet(channel, message))

    def send_raw(self, data: bytes) -> None:
        self._supervisor.send(data)

    def type(self, keys: bytes) -> None:
        os.write(self._out, keys)

    def read_until(self, text: str) -> None:
        while text not in self.shown:
            chunk = self._read()
            assert chunk, f"ended without showing {text!r}, but: {self.shown}"
            self.shown += chunk

    def close(self) -> int:
        """Ends the run; returns the display's exit code and sets `shown` to all of its output."""
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

        def start(style: str = "live", terminal: bool = True, keys: bool = False) -> Display:
            started.append(Display(style, terminal, keys))
            return started[-1]

        yield start


@contextmanager
def _ended(started: list[Display]) -> Iterator[list[Display]]:
    yield started
    for display in started:
        if display.process.poll() is None:
            display.process.kill()
            display.process.wait()


def test_display_restores_the_cursor_when_the_run_ends(start: Callable[..., Display]) -> None:
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


def test_halted_run_writes_nothing_into_a_debugger_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(display_module, "_STATUS_LINE_S", 1e-6)
    view, out = View(plan("tests.fwk.cli.cli_runs:headline")), io.StringIO()
    supervisor, end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with end:
        for tick, repeated in ((77, 1), (77, 50), (77, 100), (78, 100)):
            supervisor.send(packet("fwk/status", status(TRACKER, tick, repeated=repeated)))
        supervisor.close()
        display_module.show_lines(view, end, out, Steering(1))
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


def test_ended_by_force_it_still_restores_the_cursor(start: Callable[..., Display]) -> None:
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


class Answers(Steering):
    """Answers like a run, and notes the requests."""

    def __init__(self) -> None:
        super().__init__(1)
        self.asked: list[object] = []

    def waits_for(self) -> list[str]:
        return ["cyan1/tracker", "cyan1/camera"]

    def speed(self) -> float:
        return 1.0

    def quit(self) -> None:
        self.asked.append("quit")

    def _clock(self, verb: str, **fields: object) -> None:
        self.asked.append((verb, *fields.values()))


def test_a_run_that_waits_names_the_component(monkeypatch: pytest.MonkeyPatch) -> None:
    now_us = [1_000_000]
    for module in ("fwk.display.view", "fwk.display.display"):
        monkeypatch.setattr(f"{module}.monotonic_us", lambda: now_us[0])
    view, out = View(plan()), io.StringIO()
    packets = [packet("fwk/status", status(TRACKER, 77))] + [b""] * 30

    def arriving(*_: object) -> Iterator[bytes]:
        for each in packets:
            yield each
            now_us[0] += 500_000

    monkeypatch.setattr(display_module, "packets", arriving)
    with socket.socket() as nothing:
        display_module.show_lines(view, nothing, out, Answers())
    said = [line for line in out.getvalue().splitlines() if "waits for" in line]
    assert said == [f"tick 77   waits for cyan1/tracker, cyan1/camera, {seconds} s" for seconds in (1, 11)]


def test_a_flood_of_lines_is_counted(start: Callable[..., Display]) -> None:
    display = start(terminal=False)
    for number in range(50):
        display.send("fwk/log", log(f"loop time missed: cyan1/part{number} took {number}.5 ms"))
    display.send("fwk/log", log("found the ball"))
    assert display.close() == 0
    lines = display.shown.splitlines()
    assert len(lines) == PRINTED_MAX + 2
    assert f"... {50 - PRINTED_MAX} more info lines like: cyan1/tracker: loop time missed" in display.shown
    assert "found the ball" in display.shown


def test_lines_that_differ_are_no_flood() -> None:
    gate, groups = FloodGate(), LineGroups(10)
    texts = ["found the ball", "lost the ball", "found the goal", "lost the goal", "kicked", "stopped", "turned"]
    assert all(gate.passes(log(text), 0) for text in texts)
    for text in texts:
        groups.add(log(text))
    assert [group.text for group in groups] == texts
    groups.add(log("kicked"))
    assert [group.text for group in groups][-1] == "kicked (and 1 like it)"


def test_a_long_word_does_not_stop_the_display() -> None:
    gate, word = FloodGate(), "x" * 300_000
    assert [gate.passes(log(f"{word} at a/b, try {number}"), 0) for number in range(PRINTED_MAX + 1)].count(True) == 4
    assert gate.passes(log(f"{word} elsewhere"), 0)


def test_a_warning_that_returns_stays_one_line() -> None:
    groups = LineGroups(10)
    for number in range(5):
        line = log(f"loop time missed: tick {number} took 300.1 ms", log_t.WARNING)
        line.wall_us = number * 10_000_000
        groups.add(line)
        said = log(f"goal {number}")
        said.wall_us = line.wall_us
        groups.add(said)
    assert [group.count for group in groups if group.line.level == log_t.WARNING] == [5]
    assert sum(group.line.level == log_t.INFO for group in groups) == 5


KEYS = {
    "p": ("pause",),
    " ": ("pause",),
    "s": ("step", 1),
    "+": ("speed", 2.0),
    "-": ("speed", 0.5),
    "m": ("speed", 0.0),
    "q": "quit",
}


@pytest.mark.parametrize("typed", KEYS)
def test_keys_control_the_run(typed: str) -> None:
    view, steering = View(plan()), Answers()
    view.take(packet("fwk/status", status(TRACKER, 5)))
    press("space" if typed == " " else typed, view, steering)
    assert steering.asked == [KEYS[typed]]


def test_the_key_of_a_paused_run_resumes_it() -> None:
    view, steering = View(plan()), Answers()
    view.take(packet("fwk/status", status(TRACKER, 5, paused=True)))
    press("space", view, steering)
    assert steering.asked == [("resume",)]


def test_keys_choose_a_component_and_a_level() -> None:
    view, steering = View(plan()), Answers()
    view.take(packet("fwk/status", status(TRACKER, 5)))
    view.take(packet("fwk/log", log("found the ball", log_t.WARNING)))
    chosen = []
    for _ in range(4):
        press("tab", view, steering)
        chosen.append((view.selected, len(view.shown_lines())))
    assert chosen == [("cyan1", 1), ("cyan1/camera", 0), ("cyan1/tracker", 1), ("", 1)]
    for _ in range(3):
        press("l", view, steering)
    assert view.shown_lines() == []
    press("escape", view, steering)
    assert len(view.shown_lines()) == 1


def test_the_terminal_is_restored() -> None:
    screen, terminal = pty.openpty()
    before = termios.tcgetattr(terminal)
    with Keyboard(terminal) as keyboard:
        assert termios.tcgetattr(terminal) != before
        os.write(screen, b"q \x1b[Bx\x1b")
        assert keyboard.read() == ["q", "space", "down", "x", "escape"]
    assert termios.tcgetattr(terminal) == before
    restore(None, None)
    os.close(screen)
    os.close(terminal)


def test_keys_reach_the_display_on_a_terminal(start: Callable[..., Display]) -> None:
    display = start(keys=True)
    display.send("fwk/status", status(TRACKER, 77))
    display.read_until("q quit")
    display.type(b"\t")
    display.read_until("lines of cyan1")
    display.type(b"l")
    display.read_until("level info")
    assert display.close() == 0
    assert SHOW_CURSOR in display.shown


def test_a_repeated_traceback_is_printed_once(start: Callable[..., Display]) -> None:
    trace = "Traceback (most recent call last):\n  File \"probe.py\", line 28, in loop\nAttributeError: no 'vlaue'"
    display = start(terminal=False)
    for tick in (1, 2):
        display.send("fwk/log", log(f"failed in loop, tick {tick}\n{trace}"))
    assert display.close() == 0
    assert display.shown.count("Traceback") == 1
    assert "tick 2: AttributeError: no 'vlaue', with the same traceback as before" in display.shown

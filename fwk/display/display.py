"""The process that shows a run: a live picture on a terminal, lines of text otherwise."""

import contextlib
import os
import signal
import socket
import sys
from collections.abc import Iterator
from typing import TextIO

from rich.console import Console
from rich.live import Live

from fwk.clock import US_PER_S, monotonic_us
from fwk.display.lines import log_line, progress_of, status_line
from fwk.display.screen import screen
from fwk.display.view import View
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan

_PACKET_BYTES = 1 << 20
_REDRAW_S = 0.25
_STATUS_LINE_S = 5.0


def run_display(plan: Plan, connection: socket.socket, plain: bool) -> None:
    """Shows the run until the connection's other end is closed; for a process of its own.

    `connection` is of type SOCK_SEQPACKET; each packet is a channel's name, a zero byte and an encoded message:
    `fwk/status`, `fwk/log` and the data channels that the scoreboard wants. The sender drops what does not fit, so that
    nothing here slows the run; for the same reason this process takes the lowest priority.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the supervisor's; the display shows how it ends
    signal.signal(signal.SIGTERM, _leave)  # leaves by an exception, so that the terminal gets its cursor back
    os.nice(10)
    with contextlib.suppress(BrokenPipeError):  # the reader of our output went away; the run goes on without
        if plain or not sys.stdout.isatty():
            show_lines(View(plan), connection, sys.stdout)
        else:
            show_live(View(plan), connection, Console())


def show_lines(view: View, connection: socket.socket, out: TextIO) -> None:
    """Every log line as it comes, and the state of the run in one line each few seconds, unless it stands still."""
    due_us, shown = 0, ""
    for packet in _packets(connection, _STATUS_LINE_S):
        with contextlib.suppress(MessageError):
            line = view.take(packet) if packet else None
            if line:
                print(log_line(line), file=out, flush=True)
        if view.status and monotonic_us() >= due_us:
            due_us = monotonic_us() + round(_STATUS_LINE_S * US_PER_S)
            progress = progress_of(view.status)
            if progress != shown:
                headline = view.headline
                print(status_line(view.status), *([headline] if headline else []), sep="   ", file=out, flush=True)
            shown = progress


def show_live(view: View, connection: socket.socket, console: Console) -> None:
    """The picture, redrawn four times a second where it is; its last state stays on the terminal."""
    due_us = 0
    with Live(console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False) as live:
        for packet in _packets(connection, _REDRAW_S):
            with contextlib.suppress(MessageError):
                if packet:
                    view.take(packet)
            if monotonic_us() >= due_us:
                due_us = monotonic_us() + round(_REDRAW_S * US_PER_S)
                live.update(screen(view, console.height), refresh=True)
        live.update(screen(view, console.height), refresh=True)


def _packets(connection: socket.socket, idle_s: float) -> Iterator[bytes]:
    """Packets as they come, an empty one when nothing came for `idle_s`; ends with the connection."""
    connection.settimeout(idle_s)
    while True:
        try:
            packet = connection.recv(_PACKET_BYTES)
        except TimeoutError:
            yield b""
            continue
        except ConnectionError:
            return
        if not packet:
            return
        yield packet


def _leave(number: int, _: object) -> None:
    raise SystemExit(128 + number)

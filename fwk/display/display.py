"""Display process: a live picture of the run on a terminal, lines of text otherwise."""

import contextlib
import os
import signal
import socket
import sys
from typing import TextIO

from fwk.clock import US_PER_S, monotonic_us
from fwk.display.floods import FloodGate, Tracebacks
from fwk.display.keys import Keyboard
from fwk.display.lines import held_back_line, log_line, progress_of, status_line
from fwk.display.packets import LOOK_S, packets
from fwk.display.steering import Steering
from fwk.display.view import View
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan
from fwk.model.signals import ignore

_STATUS_LINE_S = 5.0
_WAITING_LINE_S = 10.0


def run_display(plan: Plan, connection: socket.socket, plain: bool) -> None:
    """Shows the run until the connection's other end is closed; for a process of its own.

    `connection` is of type SOCK_SEQPACKET; each packet is a channel's name, a zero byte and an encoded message:
    `fwk/status`, `fwk/log` and the data channels of the scoreboard. The sender drops packets that find no room, and
    this process has the lowest priority, so that nothing here slows the run.
    """
    ignore(signal.SIGINT)  # Ctrl-C ends the run; the display shows how
    signal.signal(signal.SIGTERM, _leave)  # raises an exception, so that the cursor of the terminal is restored
    os.nice(10)
    with contextlib.suppress(OSError):  # the reader of the output has gone; the run goes on without it
        if plain or not sys.stdout.isatty():
            show_lines(View(plan), connection, sys.stdout, Steering(plan.bus_port))
        else:
            from fwk.display.live import show_live  # a display of lines needs no rich, which takes long to import

            with Keyboard() as keyboard:
                show_live(View(plan), connection, keyboard, Steering(plan.bus_port))


def show_lines(view: View, connection: socket.socket, out: TextIO, steering: Steering) -> None:
    """Prints log lines as they come, and the state of the run in one line every few seconds while it advances.

    For a run that stands still for a second it prints the components that the run waits for, and again every ten
    seconds. For a run that is slower than desired it prints the remedy once. Of many equivalent lines, the first are
    printed and the others counted.
    """
    due_us, shown, waiting_due_us, slowness = 0, "", 0, ""
    gate, tracebacks = FloodGate(), Tracebacks()
    for packet in packets(connection, LOOK_S):
        with contextlib.suppress(MessageError):
            line = view.take(packet) if packet else None
            if line and gate.passes(line, monotonic_us()):
                print(log_line(tracebacks.shortened(line)), file=out, flush=True)
        for line, count in gate.held_back(monotonic_us()):
            print(held_back_line(line, count), file=out, flush=True)
        if view.status and monotonic_us() >= due_us:
            due_us = monotonic_us() + round(_STATUS_LINE_S * US_PER_S)
            progress = progress_of(view.status)
            if progress != shown:
                headline = view.headline
                print(status_line(view.status), *([headline] if headline else []), sep="   ", file=out, flush=True)
            shown = progress
        if view.slowness and not slowness:
            slowness = view.slowness
            print(slowness, file=out, flush=True)
        if not view.standing_s:
            waiting_due_us = 0
        elif monotonic_us() >= waiting_due_us:
            waiting_due_us = monotonic_us() + round(_WAITING_LINE_S * US_PER_S)
            view.waits_for = steering.waits_for()
            if view.waits_for:
                print(f"tick {view.status.tick if view.status else 0}   {view.waiting}", file=out, flush=True)
    for line, count in gate.held_back(sys.maxsize):
        print(held_back_line(line, count), file=out, flush=True)


def _leave(number: int, _: object) -> None:
    raise SystemExit(128 + number)

"""Live picture of a run on a terminal, with keys."""

import contextlib
import select
import socket

from rich.console import Console
from rich.live import Live

from fwk.clock import SPEED_MAX, SPEED_MIN, US_PER_S, monotonic_us
from fwk.display.keys import Keyboard
from fwk.display.packets import LOOK_S, packets
from fwk.display.screen import screen
from fwk.display.steering import Steering
from fwk.display.view import LEVELS, View
from fwk.lcm.messages import MessageError

_REDRAW_S = 0.25


def show_live(view: View, connection: socket.socket, keyboard: Keyboard, steering: Steering) -> None:
    """Redraws the picture four times a second and obeys the keys; the last picture stays on the terminal."""
    console = Console()
    due_us = look_us = 0
    with Live(console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False) as live:
        for packet in packets(connection, _REDRAW_S, keyboard):
            with contextlib.suppress(MessageError):
                if packet:
                    view.take(packet)
            for key in keyboard.read() if select.select(keyboard.descriptors, [], [], 0)[0] else ():
                press(key, view, steering)
                due_us = 0
            if view.standing_s and monotonic_us() >= look_us:
                look_us = monotonic_us() + round(LOOK_S * US_PER_S)
                view.waits_for = steering.waits_for()
            if monotonic_us() >= due_us:
                due_us = monotonic_us() + round(_REDRAW_S * US_PER_S)
                picture = screen(view, console.height, console.width, keys=bool(keyboard.descriptors))
                live.update(picture, refresh=True)
        view.message = ""
        live.update(screen(view, console.height, console.width), refresh=True)


def press(key: str, view: View, steering: Steering) -> None:
    """Carries out the action of a key."""
    view.message = ""
    if key in ("space", "p"):
        steering.toggle_pause(bool(view.status and view.status.paused))
    elif key == "s":
        steering.step()
    elif key in ("+", "=", "-"):
        speed = steering.speed() or (view.status.speed if view.status else 1.0)
        factor = 0.5 if key == "-" else 2.0
        steering.change_speed(min(SPEED_MAX, max(SPEED_MIN, float(f"{speed * factor:.2g}"))))
    elif key == "m":
        steering.change_speed(0.0)
    elif key == "q":
        steering.quit()
    elif key in ("tab", "down", "j"):
        view.select(1)
    elif key in ("up", "k"):
        view.select(-1)
    elif key == "l":
        view.level = (view.level + 1) % len(LEVELS)
    elif key == "escape":
        view.selected, view.level = "", 0
    view.message, steering.said = steering.said, ""

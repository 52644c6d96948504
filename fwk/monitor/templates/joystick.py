"""Prints axes and pressed buttons of a joystick when they change."""

from typing import Any

channels = ("*/joystick",)
shown = ""


def message(channel: str, message: Any, time_us: int) -> None:
    global shown
    axes = " ".join(f"{each:+.2f}" for each in message.axes)
    pressed = [number for number, is_pressed in enumerate(message.buttons) if is_pressed]
    text = f"{channel}: axes {axes}, buttons {pressed}"
    if text != shown:
        print(f"{time_us / 1e6:8.2f} s  {text}")
        shown = text

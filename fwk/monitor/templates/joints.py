"""Prints the joints that move, with position and velocity."""

from typing import Any

channels = ("*/joints",)
MOVES = 0.01
"""Velocity in rad/s or m/s from which a joint counts as moving."""


def message(channel: str, message: Any, time_us: int) -> None:
    for name, position, velocity in zip(message.names, message.positions, message.velocities, strict=True):
        if abs(velocity) >= MOVES:
            print(f"{time_us / 1e6:8.2f} s  {channel}: {name} at {position:.3f}, {velocity:+.3f} per second")
